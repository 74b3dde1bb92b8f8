// From karst::Policy to the C tables: the code behind KARST_POLICY. Policy authors need not read it.
#pragma once
#include <array>
#include <cstring>
#include <exception>
#include <memory>
#include <type_traits>
#include <utility>

#include <karst/memory.h>
#include <karst/policy.h>

namespace karst::border {

/// The longest beginning of the text, `limit` bytes at most, that cuts no UTF-8 sequence.
inline std::size_t whole_bytes(const char* text, std::size_t size, std::size_t limit) noexcept {
  if (size <= limit) return size;
  while (limit > 0 && (static_cast<unsigned char>(text[limit]) & 0xC0) == 0x80) --limit;
  return limit;
}

inline void fill(karst_error_t* error, std::int32_t code, const char* text) noexcept {
  if (error == nullptr) return;
  error->code = code;
  const std::size_t n = whole_bytes(text, std::strlen(text), KARST_ERROR_TEXT_SIZE - 1);
  std::memcpy(error->text, text, n);
  error->text[n] = '\0';
}

/// Runs `f`; an exception becomes an error code and a text.
template <class F>
std::int32_t guarded(karst_error_t* error, F&& f) noexcept {
  try {
    f();
    return KARST_OK;
  } catch (const Error& e) {
    const std::int32_t code = e.code() == KARST_OK ? KARST_ERROR_FAILED : e.code();
    fill(error, code, e.what());
    return code;
  } catch (const std::exception& e) {
    fill(error, KARST_ERROR_EXCEPTION, e.what());
  } catch (...) {
    fill(error, KARST_ERROR_EXCEPTION, "an exception that is not a std::exception");
  }
  return KARST_ERROR_EXCEPTION;
}

struct Hosted {
  const karst_host_t* host = nullptr;
  std::unique_ptr<Policy> policy;
  Parameters table;
};
inline Hosted& self_of(void* self) noexcept { return *static_cast<Hosted*>(self); }

inline std::int32_t init(void* self, const karst_parameter_value_t* values, std::uint64_t count,
                         karst_error_t* error) noexcept {
  return guarded(error, [&] {
    Hosted& h = self_of(self);
    h.table.assign(values, count);
    h.policy->init();
  });
}
inline std::int32_t activate(void* self, karst_error_t* error) noexcept {
  return guarded(error, [&] { self_of(self).policy->activate(); });
}
/// What one line of a decision may hold, in bytes.
constexpr std::size_t line_limit = 240;

/// Cuts what the host would refuse: goals beyond the first `max_goals`, and texts beyond the limit. One line
/// of the log tells of each kind.
inline void fit(Decision& decision, std::size_t max_goals, const Request& request) {
  std::vector<Goal>& goals = decision.goals;
  if (goals.size() > max_goals) {
    request.log("of " + std::to_string(goals.size()) + " goals only the first " + std::to_string(max_goals) +
                " are offered: the host takes no more");
    goals.resize(max_goals);
  }
  std::size_t texts = 0;
  const auto cut = [&texts](std::string& text) {
    const std::size_t n = whole_bytes(text.data(), text.size(), line_limit);
    if (n == text.size()) return;
    text.resize(n);
    ++texts;
  };
  for (Goal& g : goals) cut(g.why);
  cut(decision.reason);
  if (texts > 0)
    request.log(std::to_string(texts) + (texts == 1 ? " text is" : " texts are") + " cut to " +
                std::to_string(line_limit) + " bytes: the host takes no longer lines");
}

inline std::int32_t decide(void* self, const karst_request_t* request, const karst_decision_sink_t* sink,
                           karst_error_t* error) noexcept {
  return guarded(error, [&] {
    Hosted& h = self_of(self);
    const Request view(h.host, *request);
    Decision decision = h.policy->decide(view);
    fit(decision, sink->max_goals, view);
    std::vector<karst_goal_t> goals;
    goals.reserve(decision.goals.size());
    for (const Goal& g : decision.goals) goals.push_back(to_abi(g));
    karst_error_t e{};
    if (!goals.empty()) check(sink->add_goals(sink, goals.data(), goals.size(), &e), e);
    const std::uint32_t flags = decision.in_order ? std::uint32_t{KARST_DECISION_TOUR} : 0u;
    check(sink->set_outcome(sink, decision.outcome, flags, to_abi(decision.reason), &e), e);
  });
}
inline std::int32_t on_event(void* self, const karst_event_t* event, karst_error_t* error) noexcept {
  return guarded(error, [&] {
    self_of(self).policy->on_event(
        {event->kind, event->stamp_ns, from_abi(event->goal), from_abi(event->reason)});
  });
}
inline void deactivate(void* self) noexcept {
  guarded(nullptr, [&] { self_of(self).policy->deactivate(); });
}
inline void destroy(void* self) noexcept {
  guarded(nullptr, [&] { delete &self_of(self); });
}

template <class P>
Restorable& memory_of(void* self) {
  return static_cast<P&>(*self_of(self).policy);
}
template <class P>
std::int32_t save(void* self, const karst_state_sink_t* sink, karst_error_t* error) noexcept {
  return guarded(error, [&] {
    Memory memory;
    memory_of<P>(self).memory(memory);
    karst_error_t e{};
    const std::vector<unsigned char> bytes = memory.sealed();
    check(sink->write(sink, bytes.data(), bytes.size(), &e), e);
  });
}
template <class P>
std::int32_t restore(void* self, const void* bytes, std::uint64_t count, karst_error_t* error) noexcept {
  return guarded(error, [&] {
    Memory memory(bytes, count);
    memory_of<P>(self).memory(memory);
    memory.done();
  });
}

/// NULL for a policy that does not derive from Restorable.
template <class P>
const void* extension(void*, karst_text_t id) noexcept {
  if constexpr (std::is_base_of_v<Restorable, P>) {
    constexpr std::size_t length = sizeof KARST_STATE_EXTENSION - 1;
    if (id.length == length && std::memcmp(id.data, KARST_STATE_EXTENSION, length) == 0) {
      static constexpr karst_state_extension_t table{sizeof table, 0, &save<P>, &restore<P>};
      return &table;
    }
  }
  return nullptr;
}

template <class P>
void* create(const karst_host_t* host, karst_error_t* error) noexcept {
  Hosted* made = nullptr;
  guarded(error, [&] {
    auto h = std::make_unique<Hosted>();
    h->host = host;
    h->policy = std::make_unique<P>();
    h->policy->parameters(h->table);
    made = h.release();
  });
  return made;
}

/// A policy's table, descriptor and the texts they point to.
struct Entry {
  std::string id, version, one_line;
  Parameters table;
  std::vector<karst_parameter_t> parameters;
  karst_policy_descriptor_t descriptor{};
  karst_policy_t policy{};
};

/// The table is used for its declarations only: the fields it points to are gone when this returns.
template <class P>
std::unique_ptr<Entry> make_entry(const char* id, const char* version, const char* one_line) {
  auto e = std::make_unique<Entry>();
  e->id = id;
  e->version = version;
  e->one_line = one_line;
  P defaults;
  static_cast<Policy&>(defaults).parameters(e->table);  // may be private in P
  e->parameters = e->table.declarations();
  e->descriptor.size = sizeof e->descriptor;
  e->descriptor.id = e->descriptor.name = to_abi(e->id);
  e->descriptor.version = to_abi(e->version);
  e->descriptor.min_host[1] = 1;  // ABI 1.0 came with karst 0.1.0
  e->descriptor.parameter_count = static_cast<std::uint32_t>(e->parameters.size());
  e->descriptor.parameters = e->parameters.data();
  e->descriptor.one_line = to_abi(e->one_line);
  e->policy = {sizeof e->policy, 0,         &e->descriptor, &create<P>, &init,        &activate,
               &decide,          &on_event, &deactivate,    &destroy,   &extension<P>};
  return e;
}

/// Made once and kept as long as the process lives, since the host may ask for it until the end. NULL, which
/// the host reports, if the policy cannot be constructed.
template <class P>
const karst_policy_t* entry(const char* id, const char* version, const char* one_line) noexcept {
  try {
    static const Entry* const made = make_entry<P>(id, version, one_line).release();
    return &made->policy;
  } catch (...) {
    return nullptr;
  }
}

}  // namespace karst::border

/// One policy in this plugin. id: [a-z][a-z0-9_]*; version: semantic; one_line: what it does.
#define KARST_POLICY(Type, id, version, one_line) \
  KARST_PLUGIN(karst::border::entry<Type>(id, version, one_line))

/// Several policies in one plugin: a list of karst::border::entry<Type>(id, version, one_line).
#define KARST_PLUGIN(...)                                                                    \
  extern "C" KARST_EXPORT const karst_plugin_t* karst_plugin_entry(void) KARST_NOEXCEPT {    \
    static const auto policy = [](std::uint32_t i) noexcept -> const karst_policy_t* {       \
      const karst_policy_t* const all[] = {__VA_ARGS__};                                     \
      return i < sizeof all / sizeof all[0] ? all[i] : nullptr;                              \
    };                                                                                       \
    static const karst_plugin_t plugin = [] {                                                \
      const karst_policy_t* const all[] = {__VA_ARGS__};                                     \
      return karst_plugin_t{sizeof(karst_plugin_t), KARST_ABI_MAJOR, KARST_ABI_MINOR,        \
                            static_cast<std::uint32_t>(sizeof all / sizeof all[0]), policy}; \
    }();                                                                                     \
    return &plugin;                                                                          \
  }
