// The pair noise against what a stochastic thermostat needs of it: Groot and Warren 1997, eq. 6: <zeta> = 0,
// <zeta_ij(t) zeta_kl(t')> = delta. Every bound is five standard errors of the estimate.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <vector>

#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/noise.h"

namespace dmf::engine {
namespace {

constexpr int beads = 300;

double zeta(std::uint64_t seed, std::uint64_t step, std::uint32_t i, std::uint32_t j) {
  const StepKey key = step_key(seed, step, Stream::pair);
  return HWY_NAMESPACE::pair_noise<double>(bead_key(key, i), bead_key(key, j));
}

/// Mean of a product over all pairs of `beads` beads and some steps, in units of its standard error.
template <class Product>
double standard_errors_from(double expected, double product_deviation, int steps, Product product) {
  double sum = 0;
  std::size_t count = 0;
  for (int step = 0; step < steps; ++step)
    for (std::uint32_t i = 0; i < beads; ++i)
      for (std::uint32_t j = i + 1; j < beads; ++j, ++count) sum += product(step, i, j);
  const double n = static_cast<double>(count);
  return (sum / n - expected) / (product_deviation / std::sqrt(n));
}

TEST(Noise, IsSymmetricSoThatMomentumIsConserved) {
  for (std::uint32_t i = 0; i < 50; ++i)
    for (std::uint32_t j = 0; j < 50; ++j) EXPECT_EQ(zeta(1, 7, i, j), zeta(1, 7, j, i));
}

TEST(Noise, HasZeroMean) {
  EXPECT_LT(std::abs(standard_errors_from(0, 1, 40, [](int t, int i, int j) { return zeta(3, t, i, j); })),
            5);
}

TEST(Noise, HasUnitVariance) {
  // Of a uniform variable: <z^4> = 9/5, so z^2 deviates by sqrt(4/5).
  EXPECT_LT(std::abs(standard_errors_from(1, std::sqrt(0.8), 40,
                                          [](int t, int i, int j) { return std::pow(zeta(3, t, i, j), 2); })),
            5);
}

TEST(Noise, IsUniform) {
  std::vector<double> counts(20, 0.0);
  double total = 0;
  for (int t = 0; t < 20; ++t)
    for (std::uint32_t i = 0; i < beads; ++i)
      for (std::uint32_t j = i + 1; j < beads; ++j, ++total) {
        const double u = zeta(11, t, i, j) / std::sqrt(12.0) + 0.5;
        ++counts[std::min(19, static_cast<int>(u * 20))];
      }
  double chi_squared = 0;
  for (const double count : counts) chi_squared += std::pow(count - total / 20, 2) / (total / 20);
  EXPECT_LT(chi_squared, 19 + 5 * std::sqrt(2 * 19.0));
}

TEST(Noise, ForgetsThePreviousStep) {
  EXPECT_LT(std::abs(standard_errors_from(
                0, 1, 40, [](int t, int i, int j) { return zeta(5, t, i, j) * zeta(5, t + 1, i, j); })),
            5);
}

TEST(Noise, PairsThatShareABeadAreIndependent) {
  // The third bead is none of the others, so that no pair meets itself.
  EXPECT_LT(std::abs(standard_errors_from(
                0, 1, 40, [](int t, int i, int j) { return zeta(5, t, i, j) * zeta(5, t, i, beads + j); })),
            5);
}

TEST(Noise, TrianglesAreIndependent) {
  // key_i ^ key_j of three pairs cancel: the case that a weak mixer would show in.
  EXPECT_LT(std::abs(standard_errors_from(0, 1, 40,
                                          [](int t, int i, int j) {
                                            const std::uint32_t k = beads + 7 * i + j % 5;
                                            return zeta(5, t, i, j) * zeta(5, t, j, k) * zeta(5, t, i, k);
                                          })),
            5);
}

TEST(Noise, SeedsAreIndependent) {
  EXPECT_LT(std::abs(standard_errors_from(
                0, 1, 20, [](int t, int i, int j) { return zeta(1, t, i, j) * zeta(2, t, i, j); })),
            5);
}

TEST(Noise, WallPairsHaveZeroMeanUnitVarianceAndForget) {
  double mean = 0, square = 0, lag = 0;
  std::size_t n = 0;
  for (int t = 0; t < 40; ++t)
    for (std::uint32_t i = 0; i < beads; ++i)
      for (std::uint32_t wall = 0; wall < 200; ++wall, ++n) {
        const auto draw = [&](int step) {
          return HWY_NAMESPACE::pair_noise<double>(bead_key(step_key(9, step, Stream::pair), i),
                                                   HWY_NAMESPACE::wall_key(wall));
        };
        const double now = draw(t);
        mean += now;
        square += now * now;
        if (wall < 20) lag += now * draw(t + 1);
      }
  const double count = static_cast<double>(n);
  EXPECT_LT(std::abs(mean / std::sqrt(count)), 5);
  EXPECT_LT(std::abs(square / count - 1) * std::sqrt(count / 0.8), 5);
  EXPECT_LT(std::abs(lag / std::sqrt(count / 10)), 5);
}

}  // namespace
}  // namespace dmf::engine
