#include "sdk/python/binding/drawn_bench.h"

#include <pybind11/stl.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <karst/testing/bench.h>

#include "sdk/python/binding/arrays.h"
#include "sdk/python/binding/policy_table.h"
#include "sdk/python/binding/services.h"

namespace karst::python {
namespace {

using testing::Bench;
using testing::DrawnMap;

/// A bench, and the map that it asks for places.
class DrawnBench {
 public:
  DrawnBench(const py::object& type, double resolution_m, const std::vector<std::string>& layers,
             const Bench::Values& values)
      : map_(resolution_m, layers), bench_(plugin_of({type}), map_, values) {}

  Bench& bench() { return bench_; }
  py::array place(const std::string& name) const {
    if (name.size() != 1) throw Error("a place of a drawing is named by one letter", KARST_ERROR_ARGUMENT);
    return array_of(map_.place(name[0]));
  }
  py::array frontiers() const {
    std::vector<karst_frontier_cluster_t> all;
    for (const Frontier& f : bench_.frontiers) all.push_back(to_abi(f));
    return records(all);
  }
  void set_frontiers(const py::array& array) {
    if (!array.dtype().equal(dtype_of<karst_frontier_cluster_t>()))
      throw Error("frontiers is an array as bench.frontiers gives it", KARST_ERROR_ARGUMENT);
    const py::array whole = py::array::ensure(array, py::array::c_style);
    const auto* first = static_cast<const karst_frontier_cluster_t*>(whole.data());
    bench_.frontiers.clear();
    for (py::ssize_t i = 0; i < whole.size(); ++i) bench_.frontiers.push_back(from_abi(first[i]));
  }
  py::list sensors() const {
    py::list all;
    for (const Sensor& s : bench_.sensors) all.append(sensor_fields(s));
    return all;
  }
  void set_sensors(const std::vector<py::dict>& all) {
    std::vector<std::string> names;
    std::vector<Sensor> made;
    for (const py::dict& d : all) {
      Sensor s{};
      names.push_back(d["name"].cast<std::string>());
      s.kind = d["kind"].cast<karst_sensor_kind_t>();
      s.T_body_sensor.position = point_of(d["position_in_body"].cast<Doubles>(), "position_in_body");
      const auto q = d["orientation_in_body"].cast<std::array<double, 4>>();
      s.T_body_sensor.orientation = {q[0], q[1], q[2], q[3]};
      const auto number = [&](const char* key) { return d[key].cast<double>(); };
      s.min_range_m = number("min_range_m"), s.max_range_m = number("max_range_m");
      s.horizontal_fov_rad = number("horizontal_fov_rad");
      s.low_elevation_rad = number("low_elevation_rad"), s.high_elevation_rad = number("high_elevation_rad");
      made.push_back(s);
    }
    for (std::size_t i = 0; i < made.size(); ++i) made[i].name = to_abi(names[i]);
    bench_.sensors = made;
    names_.swap(names);  // the texts stay where they are
  }
  py::tuple decide() {
    const Decision d = bench_.decide();
    py::list goals;
    for (const Goal& g : d.goals)
      goals.append(py::make_tuple(array_of(g.position), g.heading_rad, g.tolerance_m, g.max_speed_mps,
                                  g.frontier_id, g.score, g.why));
    return py::make_tuple(d.outcome, d.in_order, d.reason, goals);
  }
  void tell(karst_event_kind_t kind, const py::object& goal, const std::string& reason) {
    bench_.tell(kind, goal_of(goal), reason);
  }
  py::bytes saved() {
    const std::vector<unsigned char> bytes = bench_.saved();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  void restart(const std::string& bytes) { bench_.restart({bytes.begin(), bytes.end()}); }
  const std::vector<std::string>& log() const { return bench_.host().log_lines; }

 private:
  DrawnMap map_;
  Bench bench_;
  std::vector<std::string> names_;  // of the sensors, if the test set them
};

/// A field of the bench that is a vector of three numbers.
template <Vec3 Bench::*Field>
void bind_vector(py::class_<DrawnBench>& c, const char* name) {
  c.def_property(
      name, [](DrawnBench& b) { return array_of(b.bench().*Field); },
      [name](DrawnBench& b, const Doubles& v) { b.bench().*Field = point_of(v, name); });
}
template <double Bench::*Field>
void bind_number(py::class_<DrawnBench>& c, const char* name) {
  c.def_property(
      name, [](DrawnBench& b) { return b.bench().*Field; },
      [](DrawnBench& b, double v) { b.bench().*Field = v; });
}

}  // namespace

void bind_bench(py::module_& module) {
  py::class_<DrawnBench> c(module, "Bench");
  c.def(py::init<const py::object&, double, const std::vector<std::string>&, const Bench::Values&>());
  bind_vector<&Bench::position>(c, "position");
  bind_vector<&Bench::start>(c, "start");
  bind_vector<&Bench::direction_of_flight>(c, "direction_of_flight");
  bind_vector<&Bench::last_goal>(c, "last_goal");
  bind_number<&Bench::heading_rad>(c, "heading_rad");
  bind_number<&Bench::time_s>(c, "time_s");
  bind_number<&Bench::seconds_before_homing>(c, "seconds_before_homing");
  bind_number<&Bench::battery_fraction>(c, "battery_fraction");
  bind_number<&Bench::battery_seconds_left>(c, "battery_seconds_left");
  bind_number<&Bench::mission_seconds_left>(c, "mission_seconds_left");
  c.def_property("frontiers", &DrawnBench::frontiers, &DrawnBench::set_frontiers);
  c.def_property("sensors", &DrawnBench::sensors, &DrawnBench::set_sensors);
  c.def("place", &DrawnBench::place);
  c.def("offer", [](DrawnBench& b, std::uint32_t id, const Doubles& viewpoint, const Doubles& centroid,
                    std::uint32_t cells) {
    const Vec3 from = point_of(viewpoint, "viewpoint"), middle = point_of(centroid, "centroid");
    b.bench().offer(id, from, middle, cells);
  });
  c.def("offer_drawn", [](DrawnBench& b, std::uint32_t min_cells) { b.bench().offer_drawn(min_cells); });
  c.def("decide", &DrawnBench::decide);
  c.def("arrive", [](DrawnBench& b) { b.bench().arrive(); });
  c.def("fail", [](DrawnBench& b, karst_event_kind_t kind, const std::string& reason) {
    b.bench().fail(kind, reason);
  });
  c.def("tell", &DrawnBench::tell);
  c.def("saved", &DrawnBench::saved);
  c.def("restart", &DrawnBench::restart);
  c.def_property_readonly("log", &DrawnBench::log);
}

}  // namespace karst::python
