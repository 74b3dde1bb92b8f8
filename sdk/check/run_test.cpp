// The child's side: runs one test and writes its result to a file.
#include <sys/resource.h>

#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/sanitized.h"
#include "sdk/check/run_check.h"

namespace karst::check {
namespace {

/// A runaway test must not exhaust the machine, and a crash needs no core file.
void limit_resources() {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  constexpr rlim_t most = rlim_t{6} << 30;
  const rlimit memory{most, most};
  if (!kSanitized) setrlimit(RLIMIT_DATA, &memory);
}

}  // namespace

void choose_policy(Context& context) {
  context.progress->enter("opening the file");
  const host::PluginFile plugin = host::open_plugin(context.file);
  context.progress->leave();
  for (const karst_policy_t* p : plugin.policies)
    if (context.id == std::string(p->descriptor->id.data, p->descriptor->id.length)) context.policy = p;
  if (context.policy == nullptr)
    throw core::InputError(context.file, context.id, "the file offers no such policy");
}

void run_test(Context& context, const Test& test, const std::filesystem::path& work) {
  limit_resources();
  Verdict verdict = Verdict::passed;
  std::string reason;
  try {
    if (test.of == Test::Of::policy || test.of == Test::Of::policy_gate) choose_policy(context);
    test.run(context);
  } catch (const Failed& f) {
    verdict = Verdict::failed;
    reason = f.reason;
  } catch (const NotApplicable& n) {
    verdict = Verdict::not_applicable;
    reason = n.reason;
  } catch (const std::exception& e) {
    verdict = Verdict::failed;
    reason = e.what();
  }
  const nlohmann::ordered_json result{
      {"outcome", core::name_of(verdict)}, {"reason", reason}, {"figures", context.figures}};
  std::ofstream out(work / "result.json");
  out << core::json_text(result) << "\n";
  if (!out.flush()) throw core::InputError((work / "result.json").string(), "", "cannot be written");
}

}  // namespace karst::check
