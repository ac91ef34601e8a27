#include "tools/van_der_waals.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <stdexcept>

namespace dmf::tools {

double VanDerWaals::pressure(double density, double temperature) const {
  return density * temperature / (1 - excluded_volume * density) - attraction * density * density;
}

VanDerWaals fit_van_der_waals(const std::vector<double>& densities, const std::vector<double>& pressures,
                              double temperature) {
  if (densities.size() < 3 || densities.size() != pressures.size())
    throw std::invalid_argument("van der Waals fit: at least three densities, and a pressure for each");
  // For a given b the best a is that of a straight line; so b alone is searched for.
  const auto with = [&](double excluded_volume) {
    double crossed = 0, squares = 0;
    for (std::size_t k = 0; k < densities.size(); ++k) {
      const double square = densities[k] * densities[k];
      crossed +=
          square * (VanDerWaals{0, excluded_volume, 0}.pressure(densities[k], temperature) - pressures[k]);
      squares += square * square;
    }
    VanDerWaals fit{crossed / squares, excluded_volume, 0};
    for (std::size_t k = 0; k < densities.size(); ++k)
      fit.residual += std::pow(fit.pressure(densities[k], temperature) - pressures[k], 2);
    fit.residual = std::sqrt(fit.residual / static_cast<double>(densities.size()));
    return fit;
  };
  const double densest = *std::max_element(densities.begin(), densities.end());
  const double best =
      boost::math::tools::brent_find_minima(
          [&](double excluded_volume) { return with(excluded_volume).residual; }, 0.0, 0.999 / densest, 40)
          .first;
  return with(best);
}

}  // namespace dmf::tools
