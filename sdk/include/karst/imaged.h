// Which surface cells the colour camera has imaged, if the host keeps that record: the extension
// "karst.imaged/1". Specification: karst_abi_imaged.h
#pragma once
#include <karst_abi_imaged.h>

#include <optional>
#include <vector>

#include <karst/chunks.h>
#include <karst/request.h>

namespace karst {

using SurfaceCell = karst_surface_cell_t;
using ImagingCamera = karst_imaged_camera_t;

/// Valid until decide() returns. Points are in the world frame, metres. All calls throw Error on failure.
class ImagedView {
 public:
  /// nullopt if this host does not know the extension, or the vehicle carries no colour camera.
  static std::optional<ImagedView> of(const karst_host_t* host) {
    static const std::string id = KARST_IMAGED_ID;
    if (!KARST_HAS(karst_host_t, host, extension)) return std::nullopt;
    const auto* service = static_cast<const karst_imaged_service_t*>(host->extension(host, to_abi(id)));
    if (service == nullptr) return std::nullopt;
    ImagedView view(host, service);
    karst_error_t e{};
    const std::int32_t code = service->camera(host, &view.camera_, &e);
    if (code == KARST_ERROR_UNAVAILABLE) return std::nullopt;
    check(code, e);
    return view;
  }

  const ImagingCamera& camera() const { return camera_; }

  /// KARST_IMAGED_* of the cell that contains each point, one for each point.
  std::vector<karst_imaged_t> states(const std::vector<Vec3>& points) const {
    std::vector<karst_imaged_t> out(points.size());
    for_chunks(points.size(), KARST_MAX_BATCH, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(service_->states(host_, points.data() + begin, size, out.data() + begin, &e), e);
    });
    return out;
  }
  std::vector<SurfaceCell> unimaged(const Box& box) const {
    const karst_box_t in{box.low, box.high};
    std::uint64_t total = 0;
    karst_error_t e{};
    check(service_->unimaged(host_, in, nullptr, 0, &total, &e), e);
    std::vector<SurfaceCell> out(total);
    check(service_->unimaged(host_, in, out.data(), out.size(), &total, &e), e);
    return out;
  }
  std::vector<std::uint64_t> newly_imaged(const std::vector<Viewpoint>& from) const {
    std::vector<std::uint64_t> out(from.size());
    for_chunks(from.size(), KARST_MAX_GAIN_VIEWPOINTS, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(service_->newly_imaged(host_, from.data() + begin, size, out.data() + begin, &e), e);
    });
    return out;
  }
  /// For each viewpoint, the centres of the cells that a picture from it would add.
  std::vector<std::vector<Vec3>> newly_imaged_cells(const std::vector<Viewpoint>& from) const {
    std::vector<std::vector<Vec3>> out;
    for_chunks(from.size(), KARST_MAX_GAIN_VIEWPOINTS, [&](std::size_t begin, std::size_t size) {
      add_newly_imaged_cells(from.data() + begin, size, out);
    });
    return out;
  }

 private:
  ImagedView(const karst_host_t* host, const karst_imaged_service_t* service)
      : host_(host), service_(service) {}

  /// Of as many viewpoints as one call takes.
  void add_newly_imaged_cells(const Viewpoint* from, std::size_t count,
                              std::vector<std::vector<Vec3>>& out) const {
    std::vector<std::uint64_t> ends(count);
    std::vector<Vec3> cells(256 * count);
    const auto ask = [&] {
      karst_error_t e{};
      check(service_->newly_imaged_cells(host_, from, count, ends.data(), cells.data(), cells.size(), &e), e);
      const std::uint64_t total = ends.empty() ? 0 : ends.back();
      const bool all = total <= cells.size();
      cells.resize(total);
      return all;
    };
    if (!ask()) ask();
    std::uint64_t begin = 0;
    for (const std::uint64_t end : ends) {
      out.emplace_back(cells.begin() + static_cast<std::ptrdiff_t>(begin),
                       cells.begin() + static_cast<std::ptrdiff_t>(end));
      begin = end;
    }
  }

  const karst_host_t* host_;
  const karst_imaged_service_t* service_;
  ImagingCamera camera_{};
};

}  // namespace karst
