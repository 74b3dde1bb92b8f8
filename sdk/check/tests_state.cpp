// state: saved and restored state, through the extension "karst.state/1".
#include "sdk/check/flight.h"
#include "sdk/check/tests.h"
#include "sdk/host/boundary/call_plugin.h"
#include "sdk/host/boundary/text.h"

namespace karst::check {
namespace {

using Of = Test::Of;

constexpr int kBefore = 10, kAfter = 10;  // number of decisions

std::unique_ptr<Object> restorable(Context& c, host::Session& session) {
  auto object = started(c, session);
  if (object->state() == nullptr) throw NotApplicable{"it does not offer " KARST_STATE_EXTENSION};
  return object;
}

void extensions(Context& c) {
  const auto session = new_session(c);
  const auto object = started(c, *session);
  if (!KARST_HAS(karst_policy_t, c.policy, extension)) throw NotApplicable{"it offers no extension at all"};
  for (const char* id : {"", "karst.no_such_thing/1", "karst.state/9", "karst.state/", "karst"})
    if (host::call_plugin(c.policy->extension, object->self(), host::view_of(id)) != nullptr)
      throw Failed{std::string("asked for the extension \"") + id +
                   "\", which it cannot know, it returns a table"};
}

void same_answers(Context& c) {
  std::string expected;
  {
    const auto session = new_session(c);
    Flight flight(c.seed, kShape);
    const auto object = restorable(c, *session);
    expected = text_of(fly(*object, flight, kBefore));
    expected += text_of(fly(*object, flight, kAfter));
  }
  const auto session = new_session(c);
  Flight flight(c.seed, kShape);
  auto object = restorable(c, *session);
  std::vector<Answer> before;
  std::vector<std::byte> bytes;
  for (int i = 0; i < kBefore; ++i) {  // saved after every decision, as in flight
    for (Answer& a : fly(*object, flight, 1)) before.push_back(std::move(a));
    require(object->save(bytes));
  }
  const std::string first = text_of(before);
  if (!expected.starts_with(first)) throw Failed{"being asked for its state changes its answers"};
  require(object->destroy());
  object = std::make_unique<Object>(c, *session);  // the same session: the host's random stream continues
  require(object->create_fault());
  require(object->init(defaults(*c.policy)));
  require(object->restore(bytes));
  require(object->activate(), "after restore()");
  if (first + text_of(fly(*object, flight, kAfter)) != expected)
    throw Failed{"restored after " + std::to_string(kBefore) +
                 " decisions it answers otherwise than if nothing had happened"};
  c.figures["bytes"] = bytes.size();
}

void damage(Context& c) {
  std::vector<std::byte> good;
  {
    const auto session = new_session(c);
    Flight flight(c.seed, kShape);
    const auto object = restorable(c, *session);
    fly(*object, flight, kBefore);
    require(object->save(good));
  }
  core::Random random = core::Random::stream(c.seed, "damaged states");
  int refused = 0, tries = 0;
  const auto attempt = [&](const std::vector<std::byte>& bytes, const std::string& what) {
    ++tries;
    const auto session = new_session(c);
    Object object(c, *session);
    require(object.create_fault());
    require(object.init(defaults(*c.policy)));
    const std::string fault = object.restore(bytes);
    if (fault.find("exception across the border") != std::string::npos) throw Failed{what + ": " + fault};
    if (!fault.empty()) {
      ++refused;
      return;
    }
    require(object.activate(), what);  // it accepted the values, so it must fly with them
    Flight flight(c.seed, kShape);
    try {
      fly(object, flight, 2);
    } catch (const Failed& f) {
      throw Failed{what + ": " + f.reason};
    }
  };
  attempt({}, "no bytes");
  attempt(std::vector<std::byte>(1u << 20, std::byte{0xff}), "a mebibyte of ones");
  attempt(std::vector<std::byte>(good.size(), std::byte{0}), "zeros");
  for (int i = 0; i < 30; ++i) {
    std::vector<std::byte> bad = good;
    if (i % 2 == 0 && !bad.empty())
      bad.resize(static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size())));
    else
      for (int k = 0; k < 3 && !bad.empty(); ++k)
        bad[static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size()))] ^=
            static_cast<std::byte>(1u << (random.bits() % 8));
    attempt(bad, "damaged state " + std::to_string(i + 1));
  }
  c.figures["tries"] = tries;
  c.figures["refused"] = refused;
}

void size(Context& c) {
  constexpr std::size_t limit = 1u << 20;  // every host stores at least this much
  const auto session = new_session(c);
  Flight flight(c.seed, kShape);
  const auto object = restorable(c, *session);
  std::vector<std::byte> bytes;
  std::size_t most = 0;
  for (int i = 0; i < 60; ++i) {
    fly(*object, flight, 1);
    require(object->save(bytes));
    most = std::max(most, bytes.size());
  }
  c.figures["bytes"] = most;
  if (most > limit)
    throw Failed{"after 60 decisions its state has " + std::to_string(most) +
                 " bytes; every host keeps 1 MiB"};
}

}  // namespace

std::vector<Test> state_tests() {
  return {
      {"state.extensions", Level::strict, Of::policy,
       "Asked for an extension it cannot know it returns NULL.", extensions},
      {"state.same_answers", Level::basic, Of::policy,
       "Restored from its saved state it answers as if nothing had happened, and saving changes nothing.",
       same_answers},
      {"state.damage", Level::basic, Of::policy,
       "A damaged state is refused, or flown with; it does no harm.", damage},
      {"state.size", Level::strict, Of::policy, "Its state fits into the mebibyte that every host keeps.",
       size},
  };
}

}  // namespace karst::check
