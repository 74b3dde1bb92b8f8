// Minimizes a function that is expensive, noisy and has no derivative, in the unit cube (NLopt).
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"

namespace karst::tuning {

using Point = std::vector<double>;  // each from 0 to 1

/// bobyqa: quadratic models around the best point (Powell, 2009); direct: divides the most promising or
/// largest boxes (DIRECT-L: Gablonsky, Kelley, 2001); crs: a population (CRS2: Kaelo, Ali, 2006).
enum class SearchMethod { bobyqa, direct, crs };
constexpr auto names_of(SearchMethod) {
  using enum SearchMethod;
  return std::to_array<core::Named<SearchMethod>>({{bobyqa, "bobyqa"}, {direct, "direct"}, {crs, "crs"}});
}

/// Throws core::InputError with the most similar name if there is none of this name.
SearchMethod search_method(const std::string& name);

struct SearchOptions {
  SearchMethod method = SearchMethod::bobyqa;
  double first_step = 0.15;  // of bobyqa, per axis
  std::uint64_t seed = 1;    // of crs
};

/// Calls `f` on one point after another, `start` first, until `enough` returns true or no improvement is
/// left. Deterministic. An exception from `f` ends the search and is rethrown.
void search(const Point& start, const SearchOptions& options, const std::function<double(const Point&)>& f,
            const std::function<bool()>& enough);

}  // namespace karst::tuning
