// The functions behind the extension "karst.survey/1".
#include "sdk/abi/karst_abi_survey.h"

#include <algorithm>

#include "sdk/host/services/serving.h"
#include "sdk/host/services/translation.h"

namespace karst::host {

struct SurveyServices {
  static_assert(KARST_SURVEY_DEFAULT_WALL_M == core::kUnmeasuredWall_m);

  static const core::SurveyedPassages& survey_of(Session& s) {
    Serving::on_decision_thread(s);
    if (s.live_.map == nullptr)
      throw Refusal{KARST_ERROR_STATE, "the survey can be asked for during decide() only"};
    if (s.survey_ == nullptr) throw Refusal{KARST_ERROR_UNAVAILABLE, "the mission has no survey"};
    return *s.survey_;
  }

  static karst_survey_size_t size_of(const core::PassageSize& s) {
    return {s.left_m, s.right_m, s.up_m, s.down_m};
  }

  /// Writes `make(i)` for the first `capacity` of `count` items.
  template <class Item, class Make>
  static void write(std::size_t count, Item* out, std::uint64_t capacity, std::uint64_t* total, Make&& make) {
    *total = count;
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(capacity, count); ++i) out[i] = make(i);
  }

  static std::int32_t legs(const karst_host_t* h, karst_survey_leg_t* out, std::uint64_t capacity,
                           std::uint64_t* total, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require(total != nullptr && (capacity == 0 || out != nullptr), "an array is NULL");
      const core::SurveyPrior& prior = survey_of(s).prior();
      write(prior.legs.size(), out, capacity, total, [&](std::uint64_t i) {
        const core::SurveyedLeg& l = prior.legs[i];
        return karst_survey_leg_t{l.from,
                                  l.to,
                                  to_abi(prior.stations[l.from]),
                                  to_abi(prior.stations[l.to]),
                                  size_of(l.from_size),
                                  size_of(l.to_size),
                                  {0, 0}};
      });
    });
  }

  static std::int32_t leads(const karst_host_t* h, karst_survey_lead_t* out, std::uint64_t capacity,
                            std::uint64_t* total, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require(total != nullptr && (capacity == 0 || out != nullptr), "an array is NULL");
      const core::SurveyPrior& prior = survey_of(s).prior();
      write(prior.leads.size(), out, capacity, total, [&](std::uint64_t i) {
        const core::SurveyLead& l = prior.leads[i];
        const karst_survey_lead_kind_t kind = l.noted ? KARST_LEAD_CONTINUATION : KARST_LEAD_END;
        return karst_survey_lead_t{to_abi(prior.stations[l.station]), l.station, kind, 0, {0, 0}};
      });
    });
  }

  static std::int32_t distances(const karst_host_t* h, const karst_vec3_t* points, std::uint64_t count,
                                double* out, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, points, out);
      const core::SurveyedPassages& survey = survey_of(s);
      for (std::uint64_t i = 0; i < count; ++i) {
        Serving::check_not_abandoned(s);
        require(finite(points[i]), "a point is not finite");
        out[i] = survey.distance_m(to_core(points[i]));
      }
    });
  }
};

const karst_survey_service_t* survey_service() {
  static const karst_survey_service_t service = {sizeof service, 0, &SurveyServices::legs,
                                                 &SurveyServices::leads, &SurveyServices::distances};
  return &service;
}

}  // namespace karst::host
