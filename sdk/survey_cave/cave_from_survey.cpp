#include "sdk/survey_cave/cave_from_survey.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/printable.h"
#include "core_stack/common/random.h"
#include "plugins/simulator/cave/mesh_volume.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/cave_generator/surface_net.h"
#include "sdk/survey/survey_checks.h"
#include "sdk/survey_cave/passage_field.h"
#include "sdk/survey_cave/passages.h"
#include "sdk/survey_cave/start_in_survey.h"
#include "sdk/survey_cave/survey_findings.h"

namespace karst::survey_cave {
namespace {

using core::format_text;
using core::InputError;
using core::Vec3;

/// A block takes 2 KB of samples and, where the wall runs, 2 KB of vertices' numbers: 6 GB at most.
constexpr std::size_t kMostBlocks = 1'500'000;

/// None if all stations are within a kilometre of the origin; else the middle of the stations, at their
/// lowest, in whole metres.
Vec3 offset_of(const survey::Survey& survey, const SurveyPart& part) {
  constexpr double kNear_m = 1000;
  Eigen::AlignedBox3d box;
  for (const std::uint32_t s : part.stations) box.extend(survey.stations[s].position_m);
  if (box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff() <= kNear_m) return Vec3::Zero();
  return {std::round(box.center().x()), std::round(box.center().y()), std::floor(box.min().z())};
}

[[noreturn]] void refuse(const std::string& file, const std::string& what, double resolution_m,
                         double factor) {
  throw InputError(file, "",
                   what + format_text("; --resolution %.2g fits, or choose a part: --survey, --around",
                                      resolution_m * factor));
}

cave::Samples samples_of(const std::string& file, const PassageField& field, const CaveOptions& options) {
  if (field.block_count() > kMostBlocks)
    refuse(file,
           format_text("the cave takes %zu blocks of 8 x 8 x 8 grid points, more than %zu",
                       field.block_count(), kMostBlocks),
           options.resolution_m,
           1.1 * std::sqrt(static_cast<double>(field.block_count()) / static_cast<double>(kMostBlocks)));
  return field.sampled();
}

/// Frees the grid points around a place: the surface then runs around it.
bool open_around(cave::Samples& s, const Vec3& place) {
  const Vec3 from_origin = (place - s.position({0, 0, 0})) / s.grid_m();
  const Eigen::Array3i cell = from_origin.array().floor().cast<int>();
  const auto opened = static_cast<float>(-0.1 * s.grid_m());
  for (int i = 0; i < 8; ++i) {
    const cave::Node n{cell.x() + (i & 1), cell.y() + (i >> 1 & 1), cell.z() + (i >> 2 & 1)};
    if (!s.has_block(n)) return false;
    if (s.at(n) > opened) s.set(n, opened);
  }
  return true;
}

std::size_t triangle_count(const cave::Samples& s) {
  std::size_t crossings = 0;
  s.for_each([&](const cave::Node& n) {
    const bool here = s.hollow(n);
    for (const cave::Node& next : {cave::Node{1, 0, 0}, cave::Node{0, 1, 0}, cave::Node{0, 0, 1}})
      crossings += here != s.hollow(n + next) ? 1u : 0u;
  });
  return 2 * crossings;
}

double surface_of(const cave::TriangleMesh& mesh) {
  double m2 = 0;
  for (const auto& t : mesh.triangles) {
    const core::Vec3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    m2 += static_cast<double>((b - a).cross(c - a).norm()) / 2;
  }
  return m2;
}

cave::TriangleMesh walls(const std::string& file, const std::vector<Tube>& tubes,
                         const std::vector<Vec3>& stations, const CaveOptions& options,
                         const std::function<void(const char*, double)>& step, SurveyReport& report) {
  const auto noise_seed = static_cast<std::uint32_t>(core::Random::stream(options.seed, "roughness").bits());
  const PassageField field(tubes, {options.resolution_m, options.roughness_m, noise_seed});
  report.walls.blocks = field.block_count();
  step("sampling", 0.1);
  cave::Samples samples = samples_of(file, field, options);
  step("surface", 0.5);
  for (const Vec3& p : stations) open_around(samples, p);
  cave::separate_sheets(samples);
  cave::keep_caves(samples, stations);
  if (const std::size_t n = triangle_count(samples); n > options.max_triangles)
    refuse(
        file,
        format_text("the cave takes %zu triangles, more than --max-triangles %zu", n, options.max_triangles),
        options.resolution_m,
        1.1 * std::sqrt(static_cast<double>(n) / static_cast<double>(options.max_triangles)));
  return cave::surface_net(samples);
}

void add_findings(const PassageGraph& graph, const Passages& passages, SurveyReport& report) {
  if (report.dimensions.without_m + report.dimensions.partly_m > 0.5 * report.passage_m)
    report.findings.emplace_back("most of the passages' dimensions are guessed: the survey lacks them");
  if (report.parts.size() > 1)
    report.findings.push_back(format_text(
        "%zu parts are not connected: a flight stays in the one in which it starts", report.parts.size()));
  if (report.dimensions.widened_m > 0.1 * report.passage_m)
    report.findings.push_back(
        format_text("%.0f m of passage are narrower than the grid shows and were widened to %.2g m "
                    "(a finer --resolution)",
                    report.dimensions.widened_m, report.dimensions.least_m));
  if (graph.size() > 1 && passages.measured_half_width_m == 0 && passages.measured_up_m == 0)
    report.findings.emplace_back("no dimension was measured here: every passage is 2 m wide and high");
}

/// What the checks are about: legs and sections of the part, and loops with two of its stations or more.
survey::Survey to_check(const survey::Survey& survey, const SurveyPart& part) {
  if (part.stations.size() == survey.stations.size()) return survey;
  std::vector<bool> in(survey.stations.size());
  std::set<std::string> names;
  for (const std::uint32_t s : part.stations) {
    in[s] = true;
    names.insert(survey.stations[s].name);
    names.insert(survey.stations[s].aliases.begin(), survey.stations[s].aliases.end());
  }
  survey::Survey here;
  here.files = survey.files;
  here.stations = survey.stations;
  const auto both_in = [&](const survey::Leg& l) { return in[l.from] && in[l.to]; };
  std::copy_if(survey.legs.begin(), survey.legs.end(), std::back_inserter(here.legs), both_in);
  const auto section_in = [&](const survey::Section& s) { return in[s.station]; };
  std::copy_if(survey.sections.begin(), survey.sections.end(), std::back_inserter(here.sections), section_in);
  for (const survey::Loops::Traverse& t : survey.loops.traverses) {
    const auto is_in = [&](const std::string& name) { return names.contains(name); };
    if (std::count_if(t.stations.begin(), t.stations.end(), is_in) > 1) here.loops.traverses.push_back(t);
  }
  return here;
}

/// As a flight checks it: in a passage, most rays cross the walls an odd number of times.
void check_start(const std::string& file, const cave::RayScene& scene, const survey::Survey& survey,
                 const std::vector<KeptStation>& stations, const Vec3& start) {
  if (cave::look_around(scene, start).odd_fraction > 0.5) return;
  const KeptStation& nearest =
      *std::min_element(stations.begin(), stations.end(), [&](const KeptStation& a, const KeptStation& b) {
        return (a.position_m - start).squaredNorm() < (b.position_m - start).squaredNorm();
      });
  const Vec3& p = nearest.position_m;
  throw InputError(
      file, "--start",
      format_text("lies in no passage; the nearest station is %.1f m away: ", (p - start).norm()) +
          core::printable(survey.stations[nearest.station].name) +
          format_text(" at \"%.2f %.2f %.2f\" of the cave", p.x(), p.y(), p.z()));
}

}  // namespace

CaveFromSurvey cave_from_survey(const std::string& file, const survey::Survey& survey,
                                const CaveOptions& options,
                                const std::function<void(const char*, double)>& progress) {
  const auto step = [&](const char* name, double fraction) {
    if (progress) progress(name, fraction);
  };
  constexpr double kLeastCells = 1.8;  // a passage so wide holds a line of grid points that are connected
  step("passages", 0);
  CaveFromSurvey made;
  SurveyReport& report = made.report;
  report.walls.resolution_m = options.resolution_m;
  report.walls.roughness_m = options.roughness_m;
  report.obstacles.vehicle_width_m = options.vehicle_width_m;
  report.dimensions.least_m = kLeastCells * options.resolution_m;
  const SurveyPart part = part_of(file, survey, options.part);
  const survey::Survey checked = to_check(survey, part);
  survey::refuse_contradictory_fixes(checked);
  report.offset_m = offset_of(survey, part);
  const PassageGraph graph = graph_of(survey, part, report.offset_m);
  const Passages passages = passages_of(survey, part, graph, report.offset_m, report.dimensions.least_m);
  if (passages.tubes.empty())
    throw InputError(file, "", "no leg underground has a length: there is no passage to make");
  tell_of_passages(survey, part, graph, passages, report);

  std::vector<Vec3> with_passage;
  for (const std::uint32_t s : part.stations) {
    made.stations.push_back({s, survey.stations[s].position_m - report.offset_m});
    if (!graph.edges[graph.node_of[s]].empty()) {
      with_passage.push_back(made.stations.back().position_m);
      continue;
    }
    ++report.walls.stations_in_rock;
    if (report.walls.bare_stations.size() < 10) report.walls.bare_stations.push_back(survey.stations[s].name);
  }
  cave::TriangleMesh mesh;
  try {
    mesh = walls(file, passages.tubes, with_passage, options, step, report);
  } catch (const std::length_error& e) {
    const Tube& widest =
        *std::max_element(passages.tubes.begin(), passages.tubes.end(),
                          [](const Tube& a, const Tube& b) { return a.reach_m() < b.reach_m(); });
    throw InputError(
        file, "",
        e.what() + format_text(" (the widest reaches %.0f m from the leg at ", widest.reach_m()) +
            survey.stations[survey.legs[widest.leg()].from].name + "): choose a part: --survey, --around");
  }
  report.walls.triangles = mesh.triangles.size();
  report.walls.volume_m3 = cave::enclosed_volume_m3(mesh);
  report.walls.surface_m2 = surface_of(mesh);

  step("start", 0.8);
  const cave::RayScene scene(std::move(mesh));
  if (options.start) check_start(file, scene, survey, made.stations, options.start->position);
  made.start = options.start ? options.start : start_in_survey(scene, survey, graph, passages);
  if (made.start)
    report.obstacles.within_reach_m =
        within_reach_m(survey, graph, passages, options.vehicle_width_m, made.start->position);
  add_findings(graph, passages, report);
  if (survey.left_out.parts > 0)
    report.findings.push_back(
        core::counted(survey.left_out.parts, "part") +
        " of the survey left out: no leg or equate ties it to the rest (see the notes)");
  for (std::string& check : survey::survey_checks(checked)) report.findings.push_back(std::move(check));
  made.mesh = scene.mesh();
  return made;
}

}  // namespace karst::survey_cave
