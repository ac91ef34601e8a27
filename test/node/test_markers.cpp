#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "frames.h"
#include "node/markers.h"
#include "node/triangulate.h"

namespace dmf::node {
namespace {

using visualization_msgs::Marker;

std::map<std::pair<std::string, int>, Marker> by_id(const visualization_msgs::MarkerArray& array) {
  std::map<std::pair<std::string, int>, Marker> result;
  for (const Marker& marker : array.markers) {
    EXPECT_TRUE(result.emplace(std::make_pair(marker.ns, marker.id), marker).second)
        << marker.ns << " " << marker.id << " twice";
    EXPECT_EQ(marker.header.frame_id, "chip");
    const auto& q = marker.pose.orientation;
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1, 1e-12) << "RViz refuses others";
  }
  return result;
}

double area(const std::vector<Eigen::Vector2d>& triangles) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Eigen::Vector2d u = triangles[i + 1] - triangles[i], v = triangles[i + 2] - triangles[i];
    const double twice = u.x() * v.y() - u.y() * v.x();
    EXPECT_GE(twice, 0) << "wound the wrong way round, RViz would draw it black";
    sum += twice / 2;
  }
  return sum;
}

class MarkersTest : public ::testing::Test {
 protected:
  chip::Scene scene_ = testing::tiny_scene_in_round_units();
  ConversionContext context_{scene_, 1000, 0.02};
  std::shared_ptr<Frame> frame_ = testing::example_frame(scene_);
};

TEST_F(MarkersTest, EachElectrodeHasItsNumberAndAColourOfItsVoltage) {
  const auto markers = by_id(chip_markers(*frame_, context_));
  ASSERT_EQ(markers.size(), 1u + 2 * 4 + 1) << "the plate, four pads with labels, the rail";
  EXPECT_EQ(markers.at({"plate", 0}).type, Marker::CUBE);
  for (int channel = 0; channel < 4; ++channel) {
    const Marker& label = markers.at({"electrode_labels", channel});
    EXPECT_EQ(label.type, Marker::TEXT_VIEW_FACING);
    EXPECT_EQ(label.text, std::to_string(channel));
    EXPECT_EQ(markers.at({"electrodes", channel}).type, Marker::TRIANGLE_LIST);
  }
  EXPECT_EQ(markers.at({"electrodes", 0}).color, markers.at({"electrodes", 2}).color);
  EXPECT_NE(markers.at({"electrodes", 0}).color, markers.at({"electrodes", 1}).color) << "63 V";
}

TEST_F(MarkersTest, TheSolidIsShownByItsVoxelsNextToTheFluid) {
  const engine::Domain& domain = scene_.parameters.domain;
  auto grid = std::make_shared<engine::LabelGrid>();
  grid->origin = domain.lower;
  grid->voxels = {5, 5, 5};
  grid->voxel_size = domain.size() / 5;
  grid->labels.assign(125, engine::LabelGrid::solid);
  grid->labels[grid->index(2, 2, 2)] = engine::LabelGrid::fluid;
  scene_.parameters.label_grid.grid = grid;
  const Marker solid = by_id(chip_markers(*frame_, context_)).at({"solid", 0});
  EXPECT_EQ(solid.type, Marker::CUBE_LIST);
  EXPECT_EQ(solid.points.size(), 6u);
  EXPECT_NEAR(solid.scale.x, context_.display_length() * domain.size().x() / 5, 1e-12);
}

TEST_F(MarkersTest, ADisabledElectrodeIsNotTakenForOneThatIsOff) {
  auto before = by_id(chip_markers(*frame_, context_));
  frame_->electrodes[2].disabled = true;
  auto after = by_id(chip_markers(*frame_, context_));
  EXPECT_NE(after.at({"electrodes", 2}).color, before.at({"electrodes", 2}).color);
  EXPECT_NE(after.at({"electrode_labels", 2}).color, before.at({"electrode_labels", 2}).color);
  EXPECT_EQ(after.at({"electrodes", 0}).color, before.at({"electrodes", 0}).color);
  frame_->electrodes[1].disabled = true;
  after = by_id(chip_markers(*frame_, context_));
  EXPECT_EQ(after.at({"electrodes", 1}).color, before.at({"electrodes", 1}).color)
      << "it is stuck on: its voltage is there all the same";
}

TEST_F(MarkersTest, TheRailSaysWhatItDoesAndWhyItWasHalted) {
  const auto rail = [this] { return by_id(chip_markers(*frame_, context_)).at({"rail", 0}); };
  const Marker on = rail();
  EXPECT_EQ(on.text, "rail 63 V, 1000 Hz");
  EXPECT_LT(on.pose.position.y, scene_.parameters.domain.lower.y() * 0.02) << "in front of the plate";
  frame_->rail.enabled = false;
  EXPECT_EQ(rail().text, "rail off");
  frame_->rail.halted = "channel 3 is shorted";
  EXPECT_EQ(rail().text, "rail halted: channel 3 is shorted");
  EXPECT_NE(rail().color, on.color);
}

TEST_F(MarkersTest, PadsLieOnThePlateAtDisplayScale) {
  const Marker pad = by_id(chip_markers(*frame_, context_)).at({"electrodes", 3});
  ASSERT_EQ(pad.points.size(), 6u) << "a square is two triangles";
  std::vector<Eigen::Vector2d> corners;
  for (const auto& point : pad.points) {
    corners.emplace_back(point.x, point.y);
    EXPECT_NEAR(point.z, 0, 0.1 * 0.02);
  }
  EXPECT_NEAR(area(corners), 25 * 0.02 * 0.02, 1e-9) << "5 r_c wide, 20 mm on the screen per r_c";
}

TEST_F(MarkersTest, BeadsAreDrawnWithTheirDroplet) {
  const auto markers = by_id(droplet_markers(*frame_, context_));
  EXPECT_EQ(markers.at({"droplets", 5}).type, Marker::SPHERE_LIST);
  EXPECT_EQ(markers.at({"droplets", 5}).points.size(), 2u);
  EXPECT_EQ(markers.at({"droplets", 7}).points.size(), 1u);
  EXPECT_NEAR(markers.at({"droplets", 7}).points[0].x, -4 * 0.02, 1e-9);
  EXPECT_EQ(markers.at({"vapour", 0}).points.size(), 1u);
  EXPECT_NE(markers.at({"droplets", 5}).color, markers.at({"droplets", 7}).color);
  EXPECT_NE(markers.at({"droplet_labels", 5}).text.find("droplet 5"), std::string::npos);
  EXPECT_NE(markers.at({"droplet_labels", 5}).text.find("100"), std::string::npos) << "the advancing angle";
}

TEST_F(MarkersTest, VapourThatCondensedLeavesTheScreen) {
  auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
  snapshot->bead_droplets.back() = 7;
  frame_->snapshot = snapshot;
  EXPECT_EQ(by_id(droplet_markers(*frame_, context_)).at({"vapour", 0}).action, Marker::DELETE);
}

TEST_F(MarkersTest, BeadsOfADropletOfThePastAreVapour) {
  auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
  snapshot->bead_droplets = {5, 5, 6, 0};
  frame_->snapshot = snapshot;
  EXPECT_EQ(by_id(droplet_markers(*frame_, context_)).at({"vapour", 0}).points.size(), 2u);
}

TEST_F(MarkersTest, AMicroparticleIsAStripedBallThatTurnsWithIt) {
  const auto markers = by_id(microparticle_markers(*frame_, context_));
  ASSERT_EQ(markers.size(), 1u);
  const Marker& ball = markers.at({"microparticles", 3});
  EXPECT_EQ(ball.type, Marker::TRIANGLE_LIST);
  EXPECT_NEAR(ball.pose.position.x, 1 * 0.02, 1e-12);
  EXPECT_NEAR(ball.pose.orientation.y, std::sin(0.5), 1e-12);
  ASSERT_EQ(ball.points.size() % 3, 0u);
  ASSERT_EQ(ball.colors.size(), ball.points.size()) << "a colour for every corner";
  double volume = 0;
  std::set<float> reds;
  for (std::size_t i = 0; i < ball.points.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      const auto& p = ball.points[i + k];
      return Eigen::Vector3d(p.x, p.y, p.z);
    };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    EXPECT_GT(normal.dot(corner(0) + corner(1) + corner(2)), 0) << "seen from outside, counter-clockwise";
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(corner(k).norm(), 1.5 * 0.02, 1e-9);
    reds.insert(ball.colors[i].r);
  }
  const double sphere = 4.0 / 3 * M_PI * std::pow(1.5 * 0.02, 3);
  EXPECT_NEAR(volume / sphere, 1, 0.05) << "closed";
  EXPECT_EQ(reds.size(), 2u) << "two colours";
}

TEST_F(MarkersTest, MagneticAndWettingMicroparticlesHaveColoursOfTheirOwn) {
  const auto colors = [this](bool magnetic, double attraction) {
    auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
    snapshot->microparticles[0].magnetic = magnetic;
    snapshot->microparticles[0].attraction = attraction;
    frame_->snapshot = snapshot;
    return microparticle_markers(*frame_, context_).markers.at(0).colors;
  };
  EXPECT_NE(colors(true, -15), colors(false, -15));
  EXPECT_NE(colors(true, -15), colors(true, -30));
}

TEST_F(MarkersTest, ADropletThatCarriesIsSeeThrough) {
  const auto markers = by_id(droplet_markers(*frame_, context_));
  EXPECT_LT(markers.at({"droplets", 5}).color.a, 0.5);
  EXPECT_GT(markers.at({"droplets", 7}).color.a, 0.5);
}

TEST_F(MarkersTest, BondsAreLinesAndMembranesTrianglesUntilTheyAreGone) {
  EXPECT_TRUE(bond_markers(*frame_, context_).markers.empty());
  auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
  engine::ChainObservation chain;
  chain.id = 2;
  chain.positions = {{0, 0, 1}, {1, 0, 1}, {1, 2, 1}};
  snapshot->chains = {chain, chain};
  engine::MembraneObservation membrane;
  membrane.id = 4;
  membrane.mesh = std::make_shared<const engine::TriangleMesh>(engine::icosphere(0));
  membrane.positions = membrane.mesh->vertices;
  snapshot->membranes = {membrane};
  frame_->snapshot = snapshot;
  const auto markers = by_id(bond_markers(*frame_, context_));
  ASSERT_EQ(markers.size(), 2u);
  const Marker& lines = markers.at({"chains", 0});
  EXPECT_EQ(lines.type, Marker::LINE_LIST);
  ASSERT_EQ(lines.points.size(), 2u * 2 * 2);
  EXPECT_EQ(lines.colors.size(), lines.points.size());
  EXPECT_NEAR(lines.points[3].y - lines.points[2].y, 2 * context_.display_length(), 1e-12);
  const Marker& surface = markers.at({"membranes", 4});
  EXPECT_EQ(surface.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(surface.points.size(), 3u * 20);
  const auto gone = by_id(bond_deletions(true, {4}, ros::Time(3)));
  ASSERT_EQ(gone.size(), 2u);
  EXPECT_EQ(gone.at({"chains", 0}).action, Marker::DELETE);
  EXPECT_EQ(gone.at({"membranes", 4}).action, Marker::DELETE);
}

TEST_F(MarkersTest, WhatIsGoneIsDeletedDropletsWithTheirLabels) {
  const auto markers = by_id(deletions({4, 9}, {9}, ros::Time(3)));
  ASSERT_EQ(markers.size(), 5u);
  for (const auto& [key, marker] : markers) EXPECT_EQ(marker.action, Marker::DELETE);
  EXPECT_EQ(markers.count({"droplet_labels", 9}), 1u);
  EXPECT_EQ(markers.count({"microparticles", 9}), 1u);
}

TEST(Triangulate, CoversAPolygonWithNotches) {
  // A comb: two teeth, area 4*1 + 2 * (1*2) = 8.
  const std::vector<Eigen::Vector2d> comb{{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_EQ(triangulate(comb).size(), 3 * (comb.size() - 2));
  EXPECT_NEAR(area(triangulate(comb)), 8, 1e-12);
}

TEST(Triangulate, EndsOnCornersThatLieOnALine) {
  const std::vector<Eigen::Vector2d> square{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  EXPECT_NEAR(area(triangulate(square)), 4, 1e-12);
}

}  // namespace
}  // namespace dmf::node
