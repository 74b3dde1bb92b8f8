#include "core_stack/objects/object_map.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

constexpr double kGate2 = 16.27;  // of chi squared with three degrees of freedom: 99.9 % lie within

struct Fused {
  Vec3 position;
  Mat3 covariance;
};

/// The average of two places, weighted by the inverses of their covariances.
Fused fuse(const Vec3& a, const Mat3& A, const Vec3& b, const Mat3& B) {
  const Mat3 gain = A * (A + B).inverse();
  const Mat3 C = A - gain * A;
  return {a + gain * (b - a), 0.5 * (C + C.transpose())};
}

/// The mean of two values that stand for so many.
double mean_of(double a, std::uint32_t n, double b, std::uint32_t m) {
  return (a * n + b * m) / static_cast<double>(n + m);
}

}  // namespace

FoundObject ObjectMap::found(const Track& t) const {
  return {t.number,    t.kind,       t.position, std::sqrt(t.covariance.trace() + 3 * t.own_variance_m2),
          t.sightings, t.first_seen, t.last_seen};
}

double ObjectMap::misfit2(const Track& t, const Vec3& position, const Mat3& covariance) const {
  const double spread2 = options_.spread_m * options_.spread_m + t.own_variance_m2;
  return mahalanobis2(position - t.position, t.covariance + covariance + spread2 * Mat3::Identity());
}

ObjectMap::Track* ObjectMap::best_fit(const Sighting& s, const std::set<std::uint32_t>& taken) {
  Track* best = nullptr;
  double least = kGate2;
  for (Track& t : tracks_) {
    if (t.kind != s.kind || taken.contains(t.id)) continue;
    if (const double misfit = misfit2(t, s.position, s.covariance); misfit < least) {
      least = misfit;
      best = &t;
    }
  }
  return best;
}

void ObjectMap::note(const ObjectDetections& look, const Pose& T_world_camera, double position_sigma_m) {
  std::erase_if(tracks_, [&](const Track& t) {
    return t.number == 0 && look.stamp - t.last_seen > from_seconds(options_.forget_after_s);
  });
  std::set<std::uint32_t> seen;  // in this image: each detection is of another object
  for (const ObjectDetection& d : look.found) {
    if (d.kind == ObjectKind::none || d.confidence < options_.min_confidence || !d.direction.allFinite() ||
        !(d.range_m > 0) || !std::isfinite(d.range_m) || !std::isfinite(d.range_sigma_m) ||
        !std::isfinite(d.bearing_sigma_rad))
      continue;
    const Sighting s = locate(d, T_world_camera);
    const double own_m2 = position_sigma_m * position_sigma_m;
    Track* t = best_fit(s, seen);
    if (t) {
      const Fused better = fuse(t->position, t->covariance, s.position, s.covariance);
      t->position = better.position;
      t->covariance = better.covariance;
      t->own_variance_m2 = mean_of(t->own_variance_m2, t->sightings, own_m2, 1);
    } else {
      tracks_.push_back({next_id_++, 0, s.kind, s.position, s.covariance, own_m2, 0, look.stamp, 0, {}, 0});
      t = &tracks_.back();
    }
    ++t->sightings;
    t->last_seen = look.stamp;
    if (t->number == 0 && t->sightings >= options_.confirm_after) t->number = next_number_++;
    for (const std::uint32_t other : seen) apart_.insert(std::minmax(other, t->id));
    seen.insert(t->id);
  }
  for (const std::uint32_t id : seen)
    if (const auto t =
            std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& o) { return o.id == id; });
        t != tracks_.end())
      merge_into(*t);
  const auto gone = [this](std::uint32_t id) {
    return !std::ranges::binary_search(tracks_, id, {}, &Track::id);
  };
  std::erase_if(apart_, [&](const auto& pair) { return gone(pair.first) || gone(pair.second); });
}

/// Takes over what other tracks hold if they are the same object. The lower number stays, as it may have been
/// told.
void ObjectMap::merge_into(Track& kept) {
  for (auto o = tracks_.begin(); o != tracks_.end();) {
    const bool same = o->id != kept.id && o->kind == kept.kind &&
                      !apart_.contains(std::minmax(o->id, kept.id)) &&
                      misfit2(kept, o->position, o->covariance) < kGate2;
    if (!same) {
      ++o;
      continue;
    }
    const Fused both = fuse(kept.position, kept.covariance, o->position, o->covariance);
    kept.position = both.position;
    kept.covariance = both.covariance;
    kept.own_variance_m2 = mean_of(kept.own_variance_m2, kept.sightings, o->own_variance_m2, o->sightings);
    kept.sightings += o->sightings;
    kept.first_seen = std::min(kept.first_seen, o->first_seen);
    kept.last_seen = std::max(kept.last_seen, o->last_seen);
    if (o->number != 0 && (kept.number == 0 || o->number < kept.number)) {
      std::swap(kept.number, o->number);
      std::swap(kept.reported, o->reported);
      std::swap(kept.reported_at, o->reported_at);
    }
    if (o->reported) withdrawn_.push_back({ObjectState::withdrawn, *o->reported});
    for (const auto& [a, b] : std::set(apart_))
      if (a == o->id || b == o->id) apart_.insert(std::minmax(a == o->id ? b : a, kept.id));
    o->id = 0;
    ++o;
  }
  std::erase_if(tracks_, [](const Track& t) { return t.id == 0; });
}

std::vector<FoundObject> ObjectMap::objects() const {
  std::vector<FoundObject> all;
  for (const Track& t : tracks_)
    if (t.number != 0) all.push_back(found(t));
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return all;
}

/// Better known: moved by more than half of what it was told to be off by, or sure to within half of that.
bool ObjectMap::worth_telling(const Track& t, TimeNs now, bool all) const {
  if (t.number == 0) return false;
  if (!t.reported) return true;
  const FoundObject is = found(t);
  const double moved_m = (is.position - t.reported->position).norm(), reported_m = t.reported->deviation_m;
  if (all) return moved_m > 0.01 || is.deviation_m < 0.95 * reported_m;
  return now - t.reported_at >= from_seconds(options_.retell_after_s) &&
         (moved_m > 0.5 * reported_m || is.deviation_m < 0.5 * reported_m);
}

std::vector<ObjectNews> ObjectMap::take_news(TimeNs now, bool all) {
  std::vector<ObjectNews> news = std::move(withdrawn_);
  withdrawn_.clear();
  for (Track& t : tracks_) {
    if (!worth_telling(t, now, all)) continue;
    news.push_back({t.reported ? ObjectState::revised : ObjectState::found, found(t)});
    t.reported = news.back().object;
    t.reported_at = now;
  }
  return news;
}

}  // namespace karst::core
