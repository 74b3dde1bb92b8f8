#include "sdk/tuning/search.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <nlopt.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::tuning {
namespace {

constexpr double kTolerance = 0.005;  // fraction of the cube's edge: finer than flights can resolve

nlopt::algorithm algorithm_of(SearchMethod method, std::size_t dimensions) {
  switch (method) {
    case SearchMethod::bobyqa:
      return dimensions > 1 ? nlopt::LN_BOBYQA : nlopt::GN_DIRECT_L;  // its models need two dimensions
    case SearchMethod::direct:
      return nlopt::GN_DIRECT_L;
    case SearchMethod::crs:
      break;
  }
  return nlopt::GN_CRS2_LM;
}

struct Search {
  const std::function<double(const Point&)>& f;
  const std::function<bool()>& enough;
  std::exception_ptr failure;
};

double call(const Point& at, Point&, void* data) {
  auto& search = *static_cast<Search*>(data);
  if (search.enough()) throw nlopt::forced_stop();
  try {
    return search.f(at);
  } catch (...) {
    search.failure = std::current_exception();
    throw nlopt::forced_stop();
  }
}

}  // namespace

SearchMethod search_method(const std::string& name) {
  if (const auto method = core::parse<SearchMethod>(name)) return *method;
  const std::vector<std::string> methods = core::all_names<SearchMethod>();
  std::string reason = "no such method; there are " + methods.front();
  for (std::size_t i = 1; i < methods.size(); ++i) reason += ", " + methods[i];
  const std::string near = core::nearest_name(name, methods);
  throw core::InputError("tune", name, reason + (near.empty() ? "" : "; did you mean " + near + "?"));
}

void search(const Point& start, const SearchOptions& options, const std::function<double(const Point&)>& f,
            const std::function<bool()>& enough) {
  nlopt::opt nlopt(algorithm_of(options.method, start.size()), static_cast<unsigned>(start.size()));
  if (enough()) return;
  f(start);
  Search state{f, enough, nullptr};
  nlopt.set_min_objective(call, &state);
  nlopt.set_lower_bounds(0.0);
  nlopt.set_upper_bounds(1.0);
  nlopt.set_xtol_abs(kTolerance);
  nlopt.set_initial_step(options.first_step);
  nlopt::srand(static_cast<unsigned long>(options.seed));
  Point at = start;
  double value = 0;
  try {
    nlopt.optimize(at, value);
  } catch (const nlopt::forced_stop&) {
  } catch (const nlopt::roundoff_limited&) {  // no further improvement is possible
  }
  if (state.failure) std::rethrow_exception(state.failure);
}

}  // namespace karst::tuning
