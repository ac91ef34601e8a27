// Contact angles of flat droplets by volume and edge or mean height, against caps whose angle is known.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/noise.h"
#include "engine/observe/contact_angle.h"
#include "tools/flat_cap.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

/// A cap cut from a sphere, by its geometry alone.
struct Cap {
  double angle, sphere;
  double foot() const { return sphere * std::sin(angle * degree); }
  double height() const { return sphere * (1 - std::cos(angle * degree)); }
  double volume() const { return M_PI * height() * height() * (3 * sphere - height()) / 3; }
  double thickness(double r) const { return std::sqrt(sphere * sphere - r * r) - sphere + height(); }
};

TEST(FlatCap, VolumeAndFootprintGiveTheAngleOfItsGeometry) {
  for (const double angle : {5.0, 10.0, 15.0, 30.0, 60.0, 90.0, 120.0}) {
    const Cap cap{angle, 40};
    EXPECT_NEAR(cap_sphere_radius(cap.volume(), angle), 40, 1e-6);
    EXPECT_NEAR(cap_angle_of_edge(cap.volume(), cap.foot(), 0).value(), angle, 1e-6);
    const double edge = 0.9 * cap.foot(), thickness = cap.thickness(edge);
    if (angle <= 90) {
      EXPECT_NEAR(cap_angle_of_edge(cap.volume(), edge, thickness).value(), angle, 1e-6);
    }
  }
}

TEST(FlatCap, WiderThanAnyCapOfItsVolumeIsAFilm) {
  // Flattest that counts, of thickness 1: r^2 = 2 V / pi (1 - 1/2) as long as it is far wider than thick.
  const double widest = std::sqrt(1000 / M_PI);
  EXPECT_TRUE(cap_angle_of_edge(1000, 0.98 * widest, 0.5));
  EXPECT_FALSE(cap_angle_of_edge(1000, 1.02 * widest, 0.5));
}

class ScatteredCap : public testing::TestWithParam<double> {
 protected:
  /// Calls visit(bead) for beads of density 6 in the cap, of the volume of a ball of radius 11, in 20 looks.
  template <class Visit, class Look>
  void scatter(Visit visit, Look look) const {
    const double volume = 4 * M_PI / 3 * 11 * 11 * 11;
    const Cap cap{GetParam(), cap_sphere_radius(volume, GetParam())};
    const double widest = GetParam() > 90 ? cap.sphere : cap.foot();
    std::uint32_t draw = 0;
    const auto number = [&] { return mix(++draw); };
    for (int k = 0; k < 20; ++k) {
      const int count = static_cast<int>(6 * 4 * widest * widest * cap.height());
      for (int bead = 0; bead < count; ++bead) {
        const Eigen::Vector3d at((2 * number() - 1) * widest, (2 * number() - 1) * widest,
                                 cap.height() * number());
        if ((at - Eigen::Vector3d(0, 0, cap.height() - cap.sphere)).norm() < cap.sphere)
          visit(Eigen::Vector3f(at.cast<float>()));
      }
      look();
    }
  }

 private:
  static double mix(std::uint32_t draw) { return engine::mix32(draw * 2654435761u) / 4294967296.0; }
};

TEST_P(ScatteredCap, ShowsItsAngleByItsEdgeAndByItsMeanHeightAndByACircleWhereOneFits) {
  CapMeter meter(6, 60);
  engine::SessileAngle circle(60, 20);
  scatter(
      [&](const Eigen::Vector3f& bead) {
        meter.add(bead);
        circle.add(bead);
      },
      [&] {
        meter.count_sample();
        circle.count_sample();
      });
  EXPECT_NEAR(meter.volume(), 4 * M_PI / 3 * 11 * 11 * 11, 60);
  EXPECT_NEAR(meter.angle_of_mean_height(), GetParam(), 0.02 * GetParam());
  ASSERT_TRUE(meter.angle_of_edge());
  // An edge found to a tenth of an r_c: 3 times that share of the angle, and rings are half an r_c wide.
  EXPECT_NEAR(*meter.angle_of_edge(), GetParam(), 0.04 * GetParam());
  // Below, most of the droplet lies in the rows that the circle leaves out.
  if (GetParam() >= 40) {
    ASSERT_TRUE(circle.angle(6));
    EXPECT_NEAR(*circle.angle(6), meter.angle_of_mean_height(), 1.5);
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, ScatteredCap, testing::Values(5.0, 8.0, 12.0, 20.0, 40.0, 60.0));

}  // namespace
}  // namespace dmf::tools
