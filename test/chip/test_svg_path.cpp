#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "chip/svg_path.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

using Eigen::Vector2d;

double area_of(const std::string& path_data) { return area(closed_path(path_data)); }

TEST(SvgPath, EveryCommandDrawsWhatTheStandardSays) {
  EXPECT_DOUBLE_EQ(area_of("M1 1 4 1 4 3 1 3z"), 6) << "pairs after a move are lines";
  EXPECT_DOUBLE_EQ(area_of("m1,1 3,0 0,2 -3,0z"), 6);
  EXPECT_DOUBLE_EQ(area_of("M0-.5L1.5-.5.5.5Z"), 0.75) << "signs and points part numbers";
  EXPECT_DOUBLE_EQ(area_of("M0 0h1e1v+1E0h-10v-1"), 10) << "back at the start is closed";
  // Chords lie inside by up to a thousandth of the curve's size, on average by two thirds of that.
  const auto inside = [](double size, double length) { return 2.0 / 3 * 1e-3 * size * length; };
  // Segment under a parabola: 2/3 of base times height, which is half of the control point's.
  EXPECT_NEAR(area_of("M0 0Q5 6 10 0z"), 20, inside(15.7, 12));
  EXPECT_NEAR(area_of("M0 0q5 6 10 0t10 0V-10H0z"), 200, inside(15.7, 1))
      << "t goes on mirrored: a hump and a hollow";
  EXPECT_NEAR(area_of("M0 0C0 10 20 10 20 0z"), 120, inside(40, 28));
  EXPECT_NEAR(area_of("M0 0c0 10 20 10 20 0s20-10 20 0V-50H0z"), 2000, inside(40, 1)) << "s goes on mirrored";
  EXPECT_NEAR(area_of("M0 0A5 5 0 0 1 10 0z"), 12.5 * M_PI, inside(5, 5 * M_PI));
  EXPECT_NEAR(area_of("M0 0A1 1 0 0 1 10 0z"), 12.5 * M_PI, inside(5, 5 * M_PI))
      << "radii too small are grown";
  EXPECT_NEAR(area_of("M5 0a5 5 0 1 1 0-.001z"), 25 * M_PI, inside(5, 10 * M_PI) + 0.001 * 5)
      << "the large arc is nearly the circle";
  EXPECT_NEAR(area_of("M0 0a10 5 90 0110 0 10 5 90 0 1-10 0z"), 50 * M_PI, inside(10, 49))
      << "an upright ellipse; flags need nothing between";
}

TEST(SvgPath, ChordsStayNearTheirCurveAtAnySize) {
  for (const double size : {1e-3, 1.0, 1e4}) {
    std::ostringstream data;
    data << "M" << size << " 0A" << size << " " << size << " 0 1 1 " << -size << " 0A" << size << " " << size
         << " 0 1 1 " << size << " 0z";
    const Polygon circle = closed_path(data.str());
    EXPECT_LT(circle.size(), 200u);
    for (std::size_t i = 0; i < circle.size(); ++i) {
      const Vector2d middle = 0.5 * (circle[i] + circle[(i + 1) % circle.size()]);
      EXPECT_NEAR(middle.norm(), size, 1.001e-3 * size);
    }
  }
}

TEST(SvgPath, TransformsActFromTheRight) {
  const Vector2d at = svg_transform("translate(10,1) rotate(90) scale(2 3)") * Vector2d(1, 1);
  EXPECT_TRUE(at.isApprox(Vector2d(10 - 3, 1 + 2))) << at.transpose();
  EXPECT_TRUE(
      (svg_transform("matrix(1 2 3 4 5 6)") * Vector2d(1, 1)).isApprox(Vector2d(1 + 3 + 5, 2 + 4 + 6)));
  EXPECT_TRUE((svg_transform("rotate(180, 5, 5)") * Vector2d(4, 5)).isApprox(Vector2d(6, 5)));
  EXPECT_TRUE((svg_transform("skewX(45),skewY(0)") * Vector2d(0, 2)).isApprox(Vector2d(2, 2)));
  for (const char* bad :
       {"rotate(1", "rotate()", "scale(1 2 3)", "turn(90)", "matrix(1 2 3)", "translate(nan)", "()"})
    EXPECT_TRUE(holds(refusal([&] { svg_transform(bad); }), "allowed: ")) << bad;
}

}  // namespace
}  // namespace dmf::chip
