// The functions behind the extension "karst.imaged/1".
#include "sdk/abi/karst_abi_imaged.h"

#include <algorithm>

#include "sdk/host/services/serving.h"
#include "sdk/host/services/translation.h"

namespace karst::host {

struct ImagedServices {
  /// The request's record of imaged surface; the surface not imaged yet is computed once for each request.
  struct Account {
    const core::VoxelMap& map;
    const core::ImagedSurface& imaged;
    const core::UnimagedSurface& unimaged;
    const core::RgbCameraModel& camera;
  };
  static const core::RgbCameraModel& camera_of(Session& s) {
    Serving::on_decision_thread(s);
    if (s.live_.map == nullptr)
      throw Refusal{KARST_ERROR_STATE, "pictures can be asked for during decide() only"};
    if (s.imaged_ == nullptr || s.rgb_ == nullptr)
      throw Refusal{KARST_ERROR_UNAVAILABLE, "the vehicle carries no colour camera"};
    return *s.rgb_;
  }
  static Account account(Session& s) {
    const core::RgbCameraModel& camera = camera_of(s);
    if (!s.unimaged_) s.unimaged_.emplace(*s.live_.map, *s.imaged_);
    return {*s.live_.map, *s.imaged_, *s.unimaged_, camera};
  }

  static std::int32_t camera(const karst_host_t* h, karst_imaged_camera_t* out, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require(out != nullptr, "out is NULL");
      const core::RgbCameraModel& model = camera_of(s);
      *out = {};
      out->sensor = to_abi(model);
      out->sensor.name = {model.camera.name.data(), model.camera.name.size()};
      out->max_incidence_rad = model.max_incidence_rad;
      out->period_s = core::seconds(model.camera.period);
    });
  }

  static std::int32_t states(const karst_host_t* h, const karst_vec3_t* points, std::uint64_t count,
                             karst_imaged_t* out, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, points, out);
      camera_of(s);  // or it is refused
      for (std::uint64_t i = 0; i < count; ++i) {
        require(finite(points[i]), "a point is not finite");
        const core::CellKey key = s.live_.map->key_of(to_core(points[i]));
        out[i] = !core::surface_cell(*s.live_.map, key) ? KARST_IMAGED_NO_SURFACE
                 : s.imaged_->contains(key)             ? KARST_IMAGED_YES
                                                        : KARST_IMAGED_NOT;
      }
    });
  }

  static std::int32_t unimaged(const karst_host_t* h, karst_box_t box, karst_surface_cell_t* out,
                               std::uint64_t capacity, std::uint64_t* total, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require(total != nullptr && (capacity == 0 || out != nullptr), "an array is NULL");
      require_box(box);
      const Account a = account(s);
      const core::Vec3 low = to_core(box.low), high = to_core(box.high);
      *total = 0;
      for (const core::SurfaceCell& cell : a.unimaged.cells()) {
        const core::Vec3 center = a.map.center_of(cell.key);
        if ((center.array() < low.array()).any() || (center.array() > high.array()).any()) continue;
        if (*total < capacity) out[*total] = {to_abi(center), to_abi(cell.normal)};
        ++*total;
      }
    });
  }

  /// Calls visit(i, indices of the cells it adds) for each viewpoint.
  template <class Visit>
  static void look(Session& s, const Account& a, const karst_viewpoint_t* from, std::uint64_t count,
                   Visit&& visit) {
    for (std::uint64_t i = 0; i < count; ++i) {
      Serving::check_not_abandoned(s);
      require(finite(from[i].position) && std::isfinite(from[i].heading_rad), "a viewpoint is not finite");
      const core::Pose T_world_body{to_core(from[i].position), core::from_heading(from[i].heading_rad)};
      visit(i, a.unimaged.seen_from(T_world_body * a.camera.camera.T_body_camera, a.camera));
    }
  }

  static std::int32_t newly_imaged(const karst_host_t* h, const karst_viewpoint_t* from, std::uint64_t count,
                                   std::uint64_t* out, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_GAIN_VIEWPOINTS, from, out);
      look(s, account(s), from, count, [&](std::uint64_t i, const auto& seen) { out[i] = seen.size(); });
    });
  }

  static std::int32_t newly_imaged_cells(const karst_host_t* h, const karst_viewpoint_t* from,
                                         std::uint64_t count, std::uint64_t* ends, karst_vec3_t* out,
                                         std::uint64_t capacity, karst_error_t* e) noexcept {
    return Serving::serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_GAIN_VIEWPOINTS, from, ends);
      require(capacity == 0 || out != nullptr, "an array is NULL");
      const Account a = account(s);
      std::uint64_t total = 0;
      look(s, a, from, count, [&](std::uint64_t i, const std::vector<std::uint32_t>& seen) {
        for (const std::uint32_t cell : seen) {
          if (total < capacity) out[total] = to_abi(a.map.center_of(a.unimaged.cells()[cell].key));
          ++total;
        }
        ends[i] = total;
      });
    });
  }
};

const karst_imaged_service_t* imaged_service() {
  static const karst_imaged_service_t service = {sizeof service,
                                                 0,
                                                 &ImagedServices::camera,
                                                 &ImagedServices::states,
                                                 &ImagedServices::unimaged,
                                                 &ImagedServices::newly_imaged,
                                                 &ImagedServices::newly_imaged_cells};
  return &service;
}

}  // namespace karst::host
