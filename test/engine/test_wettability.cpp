#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>

#include "engine/walls/walls.h"
#include "engine/wettability.h"
#include "systems.h"

namespace dmf::engine {
namespace {

TEST(LanCurve, GivesThePapersValues) {
  const ContactAngleCurve curve = ContactAngleCurve::lan2016();
  EXPECT_NEAR(curve.attraction(150), -8.765, 0.01);  // (2.39) and its plateaus, signs restored
  EXPECT_NEAR(curve.attraction(40), -21.707, 0.01);
  EXPECT_NEAR(curve.angle(-10), 143.9, 0.1);
}

TEST(Curve, InvertsItself) {
  const ContactAngleCurve curve({{-22, 40, 1}, {-18, 82, 1}, {-10, 144, 1}});
  for (double angle = 40; angle <= 144; angle += 3.7)
    EXPECT_NEAR(curve.angle(curve.attraction(angle)), angle, 1e-9);
}

TEST(Curve, RefusesAnglesThatWereNotMeasured) {
  const ContactAngleCurve curve({{-22, 40, 1}, {-10, 144, 1}});
  for (const double angle : {39.9, 144.1, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(curve.attraction(angle), InvalidInput) << angle;
}

TEST(Curve, RefusesPointsThatDoNotRise) {
  EXPECT_THROW(ContactAngleCurve({{-22, 40, 1}}), InvalidInput);
  EXPECT_THROW(ContactAngleCurve({{-22, 40, 1}, {-21, 39, 1}}), InvalidInput);
  EXPECT_THROW(ContactAngleCurve({{-22, 40, 1}, {-22, 50, 1}}), InvalidInput);
}

TEST(CalibrationFile, IsReadStrictly) {
  const std::string file = testing::TempDir() + "curve.yaml";
  const auto load = [&](const std::string& text) {
    std::ofstream(file) << text;
    return ContactAngleCurve::load(file);
  };
  const std::string head = "description: a test\ncommand: none\n";
  EXPECT_NEAR(load(head + "points: [[-22, 40, 1], [-10, 144, 1]]\n").attraction(144), -10, 1e-12);
  EXPECT_THROW(load(head + "points: [[-22, 40, 1], [-10, 30, 1]]\n"), InvalidInput);
  EXPECT_THROW(load(head + "points: [[-22, 40], [-10, 144, 1]]\n"), InvalidInput);
  EXPECT_THROW(load(head + "points: [[-22, 40, 1], [-10, 144, 1]]\ntypo: 1\n"), InvalidInput);
  EXPECT_THROW(ContactAngleCurve::load("/nonexistent.yaml"), InvalidInput);
}

TEST(Plates, HasTheLiquidsDensityAndItsFirstLayerOnThePlane) {
  const Parameters parameters = plate(20, 10);
  const Walls wall(parameters);
  const double layer_spacing = 0.5 * parameters.wall.lattice_constant;
  EXPECT_NEAR(wall.size() / (20 * 20 * 3 * layer_spacing), 6.0, 0.1);
  double top = -1e9;
  for (const Record& bead : wall.beads()) top = std::max(top, double(bead.z));
  EXPECT_EQ(top, 0.0);
}

TEST(Plates, TheTopPlateMirrorsTheLowerOneAndHasItsOwnAngle) {
  Parameters parameters = two_plates(12, 5);
  parameters.wall.top_contact_angle = 60;
  Walls wall(parameters);
  const ContactAngleCurve curve = ContactAngleCurve::lan2016();
  wall.set_wettability([](double, double) { return 120.0; }, curve);
  wall.set_fixed_wettability(parameters, curve);
  std::multiset<std::array<float, 3>> lower, mirrored;
  for (const Record& bead : wall.beads()) {
    if (bead.z <= 0) {
      lower.insert({bead.x, bead.y, -bead.z});
      EXPECT_FLOAT_EQ(bead.w, static_cast<float>(curve.attraction(120)));
    } else {
      mirrored.insert({bead.x, bead.y, bead.z - 5.f});
      EXPECT_FLOAT_EQ(bead.w, static_cast<float>(curve.attraction(60)));
    }
  }
  ASSERT_EQ(lower.size(), mirrored.size());
  auto image = mirrored.begin();
  for (const auto& bead : lower) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(bead[axis], (*image)[axis], 1e-5);
    ++image;
  }
}

TEST(Plates, FccNeighboursStandAtOneOverRootTwoOfTheLatticeConstant) {
  const Parameters parameters = plate(10, 10);
  const Walls wall(parameters);
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const Record& a = wall.beads()[i];
    if (std::abs(a.x - 5) > 2 || std::abs(a.y - 5) > 2) continue;
    double nearest = 1e9;
    for (std::size_t j = 0; j < wall.size(); ++j)
      if (j != i) {
        const Record& b = wall.beads()[j];
        nearest = std::min(nearest, Vector3d(a.x - b.x, a.y - b.y, a.z - b.z).norm());
      }
    EXPECT_NEAR(nearest, 0.874 / std::sqrt(2.0), 0.02);  // the cell is stretched to fit the period
  }
}

}  // namespace
}  // namespace dmf::engine
