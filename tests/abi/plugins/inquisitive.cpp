// Asks every service once and puts the answers into its goals' reasons, for the test to compare.
#include <karst/policy.h>

#include <sstream>

namespace {
class Inquisitive : public karst::Policy {
  karst::Decision decide(const karst::Request& r) override {
    std::vector<karst::Goal> goals;
    const auto say = [&](const auto& what) {
      std::ostringstream text;
      text << what;
      karst::Goal g;
      g.position = r.position();
      g.why = text.str();
      goals.push_back(g);
    };
    const karst_map_info_t info = r.map.info();
    say(info.free_cells);
    say(info.occupied_cells);
    say(static_cast<int>(r.map.cell({0.5, 0.5, 0.5})));
    say(r.map.cast({{{0.5, 0.5, 0.5}, {9.5, 0.5, 0.5}}}, false)[0].length_m);
    say(r.map.counts({{{0, 0, 0}, {3, 3, 3}}})[0].unknown);
    say(r.map.surface({{-100, -100, -100}, {100, 100, 100}}).size());
    say(r.sensors.size());
    say(r.newly_seen(r.sensors.at(0), {{r.position(), 0.0}})[0]);
    say(r.path_lengths(r.position(), {r.position()}, 0.5)[0]);
    say(r.random());
    r.draw_points({{1, 2, 3}}, 0x123456);
    r.draw_lines({{{0, 0, 0}, {1, 1, 1}}}, 0xff0000);
    r.draw_text({1, 1, 1}, "here", 0xffffff);
    r.log("asked everything");
    if (kept_.handle() == nullptr) kept_ = r.map.retained();
    say(kept_.info().free_cells);
    say(r.battery_fraction);
    say(r.battery_seconds_left);
    say(r.mission_seconds_left);
    say(r.map.distances_to_rock({r.position()}, 3)[0]);
    say(kept_.distances_to_rock({r.position()}, 20)[0]);
    const std::vector<karst::Path> paths =
        r.paths(r.position(), {{8.5, 5.5, 5.5}, {1.5, 1.5, 1.5}, {50, 50, 50}});
    for (const karst::Path& path : paths) {
      say(path.points.size());
      say(path.length_m);
      say(path.clearance_m);
      say(path.time_s);
    }
    const karst::Passages found = r.map.passages();
    say(found.passages.size());
    for (const karst::Passage& p : found.passages) {
      say(p.length_m);
      say(p.mean_width_m);
      say(p.volume_m3);
    }
    for (const karst::PassageEnd& e : found.ends) say(e.kind);
    const std::vector<karst::PassagePlace> places = r.map.passages_at({r.position(), {50, 50, 50}});
    say(places[0].passage);
    say(places[0].width_m);
    say(places[1].passage == karst::PassagePlace::none);
    say(kept_.passages().passages.at(0).volume_m3);
    return karst::Decision::fly(goals);
  }
  karst::MapView kept_;
};
}  // namespace
KARST_POLICY(Inquisitive, "inquisitive", "1.0.0", "Asks everything.")
