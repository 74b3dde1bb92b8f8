// entry: the file, the handshake, and the tables, before a policy object is created.
#include <algorithm>
#include <filesystem>

#include "core_stack/common/error.h"
#include "sdk/check/elf_exports.h"
#include "sdk/check/process_view.h"
#include "sdk/check/tests.h"
#include "sdk/host/boundary/call_plugin.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/plugin/script_file.h"

namespace karst::check {
namespace {

using Of = Test::Of;

const karst_plugin_t& opened(Context& c) {
  c.progress->enter("opening the file");
  const karst_plugin_t* plugin = nullptr;
  try {
    plugin = &host::enter_plugin(c.file);
  } catch (const core::InputError& e) {
    std::string reason = e.what();
    if (reason.starts_with(c.file + ": ")) reason.erase(0, c.file.size() + 2);
    throw Failed{reason};
  }
  c.progress->leave();
  return *plugin;
}

/// Collects `fault_of(policy)` for each policy in the file.
template <class Fault>
void require_of_all(Context& c, Fault&& fault_of) {
  const karst_plugin_t& plugin = opened(c);
  c.progress->enter("asking for its policies");
  for (std::uint32_t i = 0; i < plugin.policy_count; ++i)
    require(fault_of(plugin.policy(i)), "policy " + std::to_string(i));
  c.progress->leave();
}

void opens(Context& c) { opened(c); }

void handshake(Context& c) {
  const karst_plugin_t& plugin = opened(c);
  require(host::handshake_fault(plugin.abi_major, plugin.abi_minor));
}

void tables(Context& c) {
  const karst_plugin_t& plugin = opened(c);
  require(host::plugin_fault(plugin));
  require_of_all(c, host::table_fault);
  for (std::uint32_t i = 0; i < plugin.policy_count; ++i)
    if (plugin.policy(i) != plugin.policy(i))
      throw Failed{"policy() gives another table each time it is asked"};
}

void descriptor(Context& c) {
  require_of_all(c, [](const karst_policy_t* p) { return host::descriptor_fault(*p->descriptor); });
}

void parameters(Context& c) {
  require_of_all(c, [](const karst_policy_t* p) { return host::parameters_fault(*p->descriptor); });
}

void exports(Context& c) {
  if (host::is_script(c.file)) throw NotApplicable{"it is no shared object"};
  std::vector<std::string> names;
  try {
    names = exported_symbols(c.file);
  } catch (const core::InputError& e) {
    throw Failed{e.what()};
  }
  std::erase(names, KARST_PLUGIN_ENTRY_NAME);
  if (names.empty()) return;
  throw Failed{"it also exports " + names[0] +
               (names.size() == 1 ? "" : " and " + std::to_string(names.size() - 1) + " more") +
               ": build it with karst_add_policy, or with a version script"};
}

void quiet(Context& c) {
  const ProcessView before;
  const host::ProcessState state;
  opened(c);
  require(before.threads_since());
  require(before.output_since());
  require(before.signals_since());
  if (const std::string changed = state.restore(); !changed.empty()) throw Failed{"it changed " + changed};
}

void described(Context& c) {
  const auto text = [](const karst_text_t& t) { return host::cleaned(t, host::kLogLineLimit); };
  require_of_all(c, [&](const karst_policy_t* p) -> std::string {
    const karst_policy_descriptor_t& d = *p->descriptor;
    if (text(d.one_line).empty()) return "it does not say in one line what it does";
    const std::string version = text(d.version);
    if (std::count(version.begin(), version.end(), '.') != 2 || version.find_first_not_of("0123456789.") == 0)
      return "its version \"" + version + "\" is not major.minor.patch";
    for (std::uint32_t i = 0; i < d.parameter_count; ++i)
      if (text(d.parameters[i].help).empty()) return "parameter " + text(d.parameters[i].id) + " has no help";
    return "";
  });
}

}  // namespace

std::vector<Test> entry_tests() {
  return {
      {"entry.opens", Level::basic, Of::file_gate,
       "The file opens, neither crashing nor ending the process, and its entry answers.", opens},
      {"entry.handshake", Level::basic, Of::file_gate,
       "It was built for this ABI's major and for no newer minor.", handshake},
      {"entry.tables", Level::basic, Of::file_gate,
       "Every policy has a table with all mandatory slots, the same one whenever it is asked for.", tables},
      {"entry.descriptor", Level::basic, Of::file_gate,
       "Ids and texts are well formed, and this karst is not older than it needs.", descriptor},
      {"entry.parameters", Level::basic, Of::file_gate,
       "Parameters have distinct ids and known types, and defaults within their ranges.", parameters},
      {"entry.exports", Level::strict, Of::file, "It exports its entry and nothing else.", exports},
      {"entry.quiet", Level::strict, Of::file,
       "Opening it writes nothing, starts no thread and changes nothing in the process.", quiet},
      {"entry.described", Level::pedantic, Of::file,
       "It says in one line what it does, has a version of three numbers, and help for every parameter.",
       described},
  };
}

}  // namespace karst::check
