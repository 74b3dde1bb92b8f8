// The passages that a survey tells of before the flight, if the mission has one: the extension
// "karst.survey/1". Specification: karst_abi_survey.h
#pragma once
#include <karst_abi_survey.h>

#include <optional>
#include <string>
#include <vector>

#include <karst/chunks.h>
#include <karst/request.h>

namespace karst {

using SurveyLeg = karst_survey_leg_t;
using SurveyLead = karst_survey_lead_t;

/// Valid until decide() returns. Points are in the world frame, metres. All calls throw Error on failure.
class SurveyView {
 public:
  /// nullopt if this host does not know the extension, or the mission has no survey.
  static std::optional<SurveyView> of(const karst_host_t* host) {
    static const std::string id = KARST_SURVEY_ID;
    if (!KARST_HAS(karst_host_t, host, extension)) return std::nullopt;
    const auto* service = static_cast<const karst_survey_service_t*>(host->extension(host, to_abi(id)));
    if (service == nullptr) return std::nullopt;
    std::uint64_t total = 0;
    karst_error_t e{};
    const std::int32_t code = service->legs(host, nullptr, 0, &total, &e);
    if (code == KARST_ERROR_UNAVAILABLE) return std::nullopt;
    check(code, e);
    return SurveyView(host, service);
  }

  /// They do not change during a mission.
  std::vector<SurveyLeg> legs() const { return all<SurveyLeg>(service_->legs); }
  /// Where the survey ends, by station; they do not change either.
  std::vector<SurveyLead> leads() const { return all<SurveyLead>(service_->leads); }

  /// Metres from each point to the nearest surveyed passage, negative in it; +infinity if there is no leg.
  std::vector<double> distances(const std::vector<Vec3>& points) const {
    std::vector<double> out(points.size());
    for_chunks(points.size(), KARST_MAX_BATCH, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(service_->distances(host_, points.data() + begin, size, out.data() + begin, &e), e);
    });
    return out;
  }

 private:
  SurveyView(const karst_host_t* host, const karst_survey_service_t* service)
      : host_(host), service_(service) {}

  template <class Item, class Slot>
  std::vector<Item> all(Slot slot) const {
    std::uint64_t total = 0;
    karst_error_t e{};
    check(slot(host_, nullptr, 0, &total, &e), e);
    std::vector<Item> out(total);
    check(slot(host_, out.data(), out.size(), &total, &e), e);
    return out;
  }

  const karst_host_t* host_;
  const karst_survey_service_t* service_;
};

}  // namespace karst
