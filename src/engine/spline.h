#pragma once
#include <string>
#include <vector>

namespace dmf::engine {

/// Liu's conservative force of short-range repulsion and longer-range attraction (Liu eq. 18-20), in place of
/// the linear one: from the potential of every pair
///
///   U(r) = a_ij (A W(r, r_c1) - B W(r, r_c2))
///
/// with W the cubic spline of smoothed particle hydrodynamics, 1 at r = 0 and 0 from its radius on. The
/// strengths a_ij are the pairs' `attraction` (> 0); there is no many-body repulsion beside it.
struct SplineParameters {
  bool used = false;
  double repulsion = 2;          ///< A; (0, 100]
  double repulsion_radius = .8;  ///< r_c1; [0.1, 1], no farther than r_c
  double attraction = 1;         ///< B; [0, A): else two beads in one place would attract each other
  double attraction_radius = 1;  ///< r_c2; [0.1, 1]
};

struct Parameters;

/// Violated ranges, each "key: value, allowed: range".
std::vector<std::string> spline_violations(const Parameters& parameters);

}  // namespace dmf::engine
