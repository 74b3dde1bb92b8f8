#include "sdk/evaluation/decisions/recorded_answers.h"

#include "core_stack/common/time.h"
#include "sdk/host/serialization/request_log.h"

namespace karst::evaluation {

std::filesystem::path requests_file(const std::filesystem::path& run_dir) {
  return run_dir / host::kRequestLogName;
}

void for_each_answer(const std::filesystem::path& requests,
                     const std::function<bool(const RecordedAnswer&)>& visit) {
  using host::RequestLogReader;
  RequestLogReader log(requests, host::RequestReader::Keeps::map);
  for (auto kind = log.next(); kind != RequestLogReader::Kind::end; kind = log.next()) {
    if (kind != RequestLogReader::Kind::answer) continue;
    const core::DecisionRequest& request = log.request();
    if (!visit({request.sequence, core::seconds(request.stamp), log.answer()})) return;
  }
}

}  // namespace karst::evaluation
