#include "sdk/python/binding/services.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace karst::python {
namespace {

/// Runs `work` without Python's lock: other threads of Python go on. The request, if it is of one, does not
/// end meanwhile.
template <class Work>
auto unlocked(const std::shared_ptr<Term>& term, Work work) {
  const py::gil_scoped_release released;
  std::shared_lock<std::shared_mutex> held;
  if (term) held = term->held();
  return work();
}

std::vector<karst_segment_t> segments_of(const Doubles& from, const Doubles& to) {
  const std::vector<Vec3> a = points_of(from, "start"), b = points_of(to, "end");
  if (a.size() != b.size() && a.size() != 1)
    throw Error("start has " + std::to_string(a.size()) + " rows and end has " + std::to_string(b.size()) +
                    ": as many, or one place to begin all",
                KARST_ERROR_ARGUMENT);
  std::vector<karst_segment_t> out;
  out.reserve(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) out.push_back({a.size() == 1 ? a[0] : a[i], b[i]});
  return out;
}

Box box_of(const Doubles& low, const Doubles& high) { return {point_of(low, "low"), point_of(high, "high")}; }

}  // namespace

py::dict Map::info() const {
  const karst_map_info_t i = view().info();
  using namespace pybind11::literals;
  return py::dict("resolution_m"_a = i.resolution_m, "revision"_a = i.revision, "free_cells"_a = i.free_cells,
                  "occupied_cells"_a = i.occupied_cells);
}

py::array Map::cells(const Doubles& points) const {
  const std::vector<Vec3> at = points_of(points, "points");
  const std::vector<Cell> found = unlocked(term_, [&] { return view().cells(at); });
  return py::array_t<std::uint8_t>(static_cast<py::ssize_t>(found.size()),
                                   reinterpret_cast<const std::uint8_t*>(found.data()));
}

py::array Map::cast_rays(const Doubles& from, const Doubles& to, bool through_unknown) const {
  const std::vector<karst_segment_t> rays = segments_of(from, to);
  return records(unlocked(term_, [&] { return view().cast(rays, through_unknown); }));
}

py::array Map::counts(const Doubles& low, const Doubles& high) const {
  const std::vector<Vec3> lows = points_of(low, "low"), highs = points_of(high, "high");
  if (lows.size() != highs.size())
    throw Error("low and high must have as many rows: a box each", KARST_ERROR_ARGUMENT);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < lows.size(); ++i) boxes.push_back({lows[i], highs[i]});
  const std::vector<karst_cell_counts_t> found = unlocked(term_, [&] { return view().counts(boxes); });
  static_assert(sizeof(karst_cell_counts_t) == 3 * sizeof(std::uint64_t), "unknown, free, occupied");
  const std::uint64_t* first = found.empty() ? nullptr : &found.front().unknown;
  return py::array_t<std::uint64_t>({static_cast<py::ssize_t>(found.size()), py::ssize_t{3}}, first);
}

py::array Map::surface(const Doubles& low, const Doubles& high) const {
  const Box box = box_of(low, high);
  return array_of(unlocked(term_, [&] { return view().surface(box); }));
}

py::array Map::distances_to_rock(const Doubles& points, double limit_m) const {
  const std::vector<Vec3> at = points_of(points, "points");
  return numbers(unlocked(term_, [&] { return view().distances_to_rock(at, limit_m); }));
}

py::tuple Map::passages() const {
  // As the host has them: indices of ends as pairs.
  const Passages found = unlocked(term_, [&] { return view().passages(); });
  std::vector<karst_passage_t> passages;
  for (const Passage& p : found.passages)
    passages.push_back({{static_cast<std::uint32_t>(p.from), static_cast<std::uint32_t>(p.to)},
                        p.length_m,
                        p.mean_width_m,
                        p.least_width_m,
                        p.mean_height_m,
                        p.least_height_m,
                        p.volume_m3,
                        p.frontier_m2,
                        p.middle,
                        {0, 0}});
  std::vector<karst_passage_end_t> ends;
  for (const PassageEnd& e : found.ends)
    ends.push_back({e.position,
                    e.from_start_m,
                    e.width_m,
                    e.height_m,
                    e.volume_m3,
                    e.frontier_m2,
                    e.kind,
                    e.ways,
                    {0, 0}});
  return py::make_tuple(records(passages), records(ends));
}

py::array Map::passages_at(const Doubles& points) const {
  const std::vector<Vec3> at = points_of(points, "points");
  const std::vector<PassagePlace> found = unlocked(term_, [&] { return view().passages_at(at); });
  const auto index = [](std::size_t i) {
    return i == PassagePlace::none ? KARST_NO_PASSAGE : static_cast<std::uint32_t>(i);
  };
  std::vector<karst_passage_place_t> places;
  for (const PassagePlace& p : found)
    places.push_back({index(p.passage), index(p.junction), p.from_start_m, p.width_m, p.height_m});
  return records(places);
}

Map Map::retained() const {
  Map copy(unlocked(term_, [&] { return view().retained(); }), std::make_shared<Term>(), kept_);
  kept_->add(copy.view_, copy.term_);
  return copy;
}

py::array Services::path_lengths(const Doubles& from, const Doubles& goals, double tolerance_m) const {
  const Vec3 start = point_of(from, "start");
  const std::vector<Vec3> to = points_of(goals, "goals");
  return numbers(unlocked(term_, [&] { return request().path_lengths(start, to, tolerance_m); }));
}

py::list Services::paths(const Doubles& from, const Doubles& goals, double tolerance_m) const {
  const Vec3 start = point_of(from, "start");
  const std::vector<Vec3> to = points_of(goals, "goals");
  const std::vector<Path> found = unlocked(term_, [&] { return request().paths(start, to, tolerance_m); });
  py::list out;
  for (const Path& p : found)
    out.append(py::make_tuple(array_of(p.points), p.length_m, p.clearance_m, p.time_s));
  return out;
}

py::array Services::newly_seen(std::size_t sensor, const Doubles& viewpoints,
                               std::optional<double> max_range_m) const {
  const std::size_t count = request().sensors.size();
  if (sensor >= count)
    throw Error(count == 0 ? "the vehicle has no sensor"
                           : "there is no sensor " + std::to_string(sensor) + ": the vehicle has " +
                                 std::to_string(count) + ", and the first is sensor 0",
                KARST_ERROR_ARGUMENT);
  Sensor with = request().sensors[sensor];
  if (max_range_m) with.max_range_m = std::min(*max_range_m, with.max_range_m);
  const std::vector<Viewpoint> from = viewpoints_of(viewpoints);
  return numbers(unlocked(term_, [&] { return request().newly_seen(with, from); }));
}

void Services::draw_points(const Doubles& points, std::uint32_t rgb) const {
  request().draw_points(points_of(points, "points"), rgb);
}
void Services::draw_lines(const Doubles& from, const Doubles& to, std::uint32_t rgb) const {
  request().draw_lines(segments_of(from, to), rgb);
}
void Services::draw_text(const Doubles& at, const std::string& text, std::uint32_t rgb) const {
  request().draw_text(point_of(at, "at"), text, rgb);
}
void Services::log(const std::string& text, std::uint32_t level) const {
  host()->log(host(), level, to_abi(text));
}
py::array_t<double> Services::random(std::size_t count) const {
  py::array_t<double> out(static_cast<py::ssize_t>(count));
  host()->random(host(), out.mutable_data(), count);
  return out;
}

SurveyView Services::known_survey() const {
  std::optional<SurveyView> view = SurveyView::of(host());
  if (!view) throw Error("the mission has no survey", KARST_ERROR_UNAVAILABLE);
  return *view;
}
py::object Services::survey() const {
  const std::optional<SurveyView> view = SurveyView::of(host());
  if (!view) return py::none();
  return py::make_tuple(records(view->legs()), records(view->leads()));
}
py::array Services::survey_distances(const Doubles& points) const {
  return numbers(known_survey().distances(points_of(points, "points")));
}

ImagedView Services::imaged() const {
  std::optional<ImagedView> view = ImagedView::of(host());
  if (!view) throw Error("the vehicle carries no colour camera", KARST_ERROR_UNAVAILABLE);
  return *view;
}
py::object Services::imaging_camera() const {
  const std::optional<ImagedView> view = ImagedView::of(host());
  if (!view) return py::none();
  const ImagingCamera& c = view->camera();
  return py::make_tuple(sensor_fields(c.sensor), c.max_incidence_rad, c.period_s);
}
py::array Services::imaged_states(const Doubles& points) const {
  return numbers(imaged().states(points_of(points, "points")));
}
py::array Services::unimaged(const Doubles& low, const Doubles& high) const {
  return records(imaged().unimaged(box_of(low, high)));
}
py::array Services::newly_imaged(const Doubles& viewpoints) const {
  return numbers(imaged().newly_imaged(viewpoints_of(viewpoints)));
}

py::dict sensor_fields(const Sensor& s) {
  using namespace pybind11::literals;
  return py::dict("name"_a = from_abi(s.name), "kind"_a = s.kind,
                  "position_in_body"_a = array_of(Vec3(s.T_body_sensor.position)),
                  "orientation_in_body"_a = array_of(s.T_body_sensor.orientation),
                  "min_range_m"_a = s.min_range_m, "max_range_m"_a = s.max_range_m,
                  "horizontal_fov_rad"_a = s.horizontal_fov_rad, "low_elevation_rad"_a = s.low_elevation_rad,
                  "high_elevation_rad"_a = s.high_elevation_rad);
}

void bind_services(py::module_& module) {
  py::class_<Map>(module, "Map")
      .def("info", &Map::info)
      .def("cells", &Map::cells)
      .def("cast_rays", &Map::cast_rays)
      .def("counts", &Map::counts)
      .def("surface", &Map::surface)
      .def("distances_to_rock", &Map::distances_to_rock)
      .def("passages", &Map::passages)
      .def("passages_at", &Map::passages_at)
      .def("retained", &Map::retained);
  py::class_<Services>(module, "Services")
      .def("map", &Services::map)
      .def("path_lengths", &Services::path_lengths)
      .def("paths", &Services::paths)
      .def("newly_seen", &Services::newly_seen)
      .def("draw_points", &Services::draw_points)
      .def("draw_lines", &Services::draw_lines)
      .def("draw_text", &Services::draw_text)
      .def("log", &Services::log)
      .def("random", &Services::random)
      .def("should_stop", &Services::should_stop)
      .def("survey", &Services::survey)
      .def("survey_distances", &Services::survey_distances)
      .def("imaging_camera", &Services::imaging_camera)
      .def("imaged_states", &Services::imaged_states)
      .def("unimaged", &Services::unimaged)
      .def("newly_imaged", &Services::newly_imaged);
}

}  // namespace karst::python
