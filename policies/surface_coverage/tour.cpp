#include "tour.h"

#include <cmath>

namespace surface_coverage {
namespace {

class Search {
 public:
  Search(const std::vector<double>& gain, const std::vector<double>& first_s,
         const std::vector<std::vector<double>>& between_s, double patience_s)
      : gain_(gain),
        first_s_(first_s),
        between_s_(between_s),
        patience_s_(patience_s),
        used_(gain.size(), false) {
    for (const double g : gain) left_ += g;
    extend(0, 0);
  }
  const std::vector<std::size_t>& best() const { return best_; }

 private:
  void extend(double arrival_s, double sum) {
    if (order_.size() == gain_.size()) {
      if (best_.empty() || sum > best_sum_) {
        best_ = order_;
        best_sum_ = sum;
      }
      return;
    }
    // Bound: even all the gain left, collected now, would not beat the best order.
    if (!best_.empty() && sum + left_ * std::exp(-arrival_s / patience_s_) <= best_sum_) return;
    for (std::size_t i = 0; i < gain_.size(); ++i) {
      if (used_[i]) continue;
      const double there_s = arrival_s + (order_.empty() ? first_s_[i] : between_s_[order_.back()][i]);
      used_[i] = true;
      left_ -= gain_[i];
      order_.push_back(i);
      extend(there_s, sum + gain_[i] * std::exp(-there_s / patience_s_));
      order_.pop_back();
      used_[i] = false;
      left_ += gain_[i];
    }
  }

  const std::vector<double>&gain_, &first_s_;
  const std::vector<std::vector<double>>& between_s_;
  double patience_s_, left_ = 0, best_sum_ = 0;
  std::vector<bool> used_;
  std::vector<std::size_t> order_, best_;
};

}  // namespace

std::vector<std::size_t> best_order(const std::vector<double>& gain, const std::vector<double>& first_s,
                                    const std::vector<std::vector<double>>& between_s, double patience_s) {
  return Search(gain, first_s, between_s, patience_s).best();
}

}  // namespace surface_coverage
