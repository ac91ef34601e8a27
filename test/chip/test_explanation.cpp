#include <gtest/gtest.h>

#include <cmath>

#include "chip/experiment.h"
#include "chip/explanation.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

constexpr double kOn = 0.5, kRest = -0.3420201433;  // cosines of 60 and 110 degrees

// Four pads, 11 r_c wide, 1 apart: channel 0 from x = -23.5 to -12.5, channel 1 from -11.5 to -0.5, ...
const char* const kScene = R"(
domain: {lower: [-30, -15, 0], upper: [30, 15, 14]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 1
  grids: [{origin: [-18, 0], columns: 4, rows: 1, pitch: 12}]
  electrowetting:
    {reference_voltage: 63, reference_angle: 60, saturation_angle: 60, max_voltage: 80, threshold_voltage: 25KEYS}
)";

std::shared_ptr<const Scene> scene(const std::string& keys = "", const std::string& more = "") {
  std::string text = kScene;
  text.replace(text.find("KEYS"), 4, keys);
  return std::make_shared<const Scene>(parse_scene(text + more, "scene.yaml"));
}

Polygon circle(double x, double y, double radius) {
  Polygon corners;
  for (int k = 0; k < 400; ++k) {
    const double angle = k * 2 * M_PI / 400;
    corners.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle));
  }
  return corners;
}

engine::DropletObservation droplet(double x, double y, double radius) {
  engine::DropletObservation seen;
  seen.id = 2;
  for (const auto& corner : circle(x, y, radius)) seen.footprint.push_back(corner.cast<float>());
  return seen;
}

/// A droplet of radius 5 at (x, 0) after commands on a board where all is off.
DropletExplanation explained(double x, const std::vector<Command>& commands,
                             std::shared_ptr<const Scene> on = scene()) {
  Board board(on);
  for (const Command& command : commands) board.apply(command);
  return explain_droplet(droplet(x, 0, 5), board, *on);
}

// The chord rule: a contact line from one point to another pulls across their chord, whatever its shape. The
// half of a circle over a pad pulls with 2 R cos(theta_on).
TEST(LinePull, OfACircleHalfOverAPadIsItsChordTimesTheDifferenceOfTheCosines) {
  const LinePull pull = line_pull(
      circle(3, 1, 5), [](double x, double) { return x > 3 ? 60.0 : 110.0; }, 0.05);
  EXPECT_NEAR(pull.net.x(), 10 * (kOn - kRest), 0.01);
  EXPECT_NEAR(pull.net.y(), 0, 1e-9);
  EXPECT_NEAR(pull.sides[0], 10 * kOn, 0.01);
  EXPECT_NEAR(pull.sides[2], 10 * kRest, 0.01);
  EXPECT_NEAR(pull.sides[1], 5 * (kOn + kRest), 0.01);
  EXPECT_NEAR(pull.sides[3], 5 * (kOn + kRest), 0.01);
}

TEST(LinePull, OverACornerIsTheSumOfTwoChords) {
  // A quarter of the circle over the pad: R from the side, R from above.
  const LinePull pull = line_pull(
      circle(0, 0, 4), [](double x, double y) { return x > 0 && y > 0 ? 60.0 : 110.0; }, 0.05);
  EXPECT_NEAR(pull.net.x(), 4 * (kOn - kRest), 0.01);
  EXPECT_NEAR(pull.net.y(), 4 * (kOn - kRest), 0.01);
}

TEST(LinePull, OfOneAngleIsNone) {
  EXPECT_NEAR(line_pull(
                  circle(0, 0, 4), [](double, double) { return 75.0; }, 0.3)
                  .net.norm(),
              0, 1e-12);
}

TEST(DropletExplanation, DrivingForceIsTheSurfaceTensionTimesThePull) {
  // Half over channel 1, the ramp before whose edge is centred on x = -12.
  const DropletExplanation result = explained(-12, {SetHv{63, 0, true}, SetElectrodes{{1}}});
  const double tension = engine::LiquidParameters{}.surface_tension;
  EXPECT_NEAR(result.driving_force.x() / (tension * 10 * (kOn - kRest)), 1, 0.02);
  EXPECT_NEAR(result.driving_force.y(), 0, 1e-6);
  EXPECT_NEAR(result.side_forces[0] - result.side_forces[2], result.driving_force.x(), 1e-9);
  EXPECT_NEAR(result.side_forces[1], result.side_forces[3], 1e-3);
  EXPECT_EQ(result.channels, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(result.nearest_channel, 1u);
  EXPECT_EQ(result.nearest_distance, 0);
  // eta(V_T) = 25^2 (cos 60 - cos 110) / (63^2 - 25^2) on the chord.
  EXPECT_NEAR(result.opposing_force / (tension * 10 * 625 * (kOn - kRest) / (3969 - 625)), 1, 0.02);
  EXPECT_TRUE(holds(result.message, "droplet 2 is pulled towards channel 1; driving force ("));
}

TEST(DropletExplanation, BelowTheThresholdSaysWhichVoltageWouldDo) {
  const DropletExplanation result = explained(-12, {SetHv{20, 0, true}, SetElectrodes{{1}}});
  EXPECT_NEAR(result.driving_force.norm(), 0, 1e-6);
  ASSERT_TRUE(result.needed_voltage);
  // gamma 2 R eta(V) = 10 k_BT / (10 sqrt 2) gives eta = 0.00938: V^2 = 25^2 + 0.00938 * 3344 / 0.842.
  EXPECT_NEAR(*result.needed_voltage, 25.74, 0.11);
  EXPECT_EQ(result.message,
            "droplet 2 does not move: channel 1 is on at 20 V, below the threshold of 25 V; 25.8 V would do");
}

TEST(DropletExplanation, WhatItNeedsIsWhatMovesIt) {
  const std::vector<Command> off{SetHv{20, 0, true}, SetElectrodes{{1}}};
  const double needed = explained(-15, off).needed_voltage.value();
  const auto at = [](double voltage) {
    return explained(-15, {SetHv{voltage, 0, true}, SetElectrodes{{1}}}).message;
  };
  EXPECT_TRUE(holds(at(needed), "is pulled towards channel 1"));
  EXPECT_TRUE(holds(at(needed - 0.2), "does not move"));
}

TEST(DropletExplanation, OutOfReachSaysHowFar) {
  const DropletExplanation result = explained(-18, {SetHv{63, 0, true}, SetElectrodes{{2}}});
  EXPECT_EQ(result.nearest_channel, 2u);
  EXPECT_NEAR(result.nearest_distance, 13.5, 1e-4);  // from -13 to 0.5
  EXPECT_FALSE(result.needed_voltage);
  EXPECT_EQ(result.message,
            "droplet 2 does not move: its footprint does not reach channel 2 (0.135 mm away)");
}

TEST(DropletExplanation, FaultsAreCalledByName) {
  const auto with_fault = [](const std::vector<Command>& more) {
    std::vector<Command> commands{SetHv{63, 0, true}, SetElectrodes{{1}}};
    commands.insert(commands.end(), more.begin(), more.end());
    return explained(-12, commands);
  };
  EXPECT_EQ(with_fault({InjectFault{fault::kStuckOff, 1}}).message,
            "droplet 2 does not move: channel 1 is stuck off");
  EXPECT_FALSE(with_fault({InjectFault{fault::kStuckOff, 1}}).needed_voltage);
  EXPECT_EQ(with_fault({SetDisabledChannels{{1}}}).message, "droplet 2 does not move: channel 1 is disabled");
  EXPECT_EQ(with_fault({InjectFault{fault::kDisconnected}}).message,
            "droplet 2 does not move: the chip is disconnected");
  const DropletExplanation weak = with_fault({InjectFault{fault::kWeak, 1, 0.35}});
  EXPECT_EQ(
      weak.message,
      "droplet 2 does not move: channel 1 has 0.35 of its voltage, 22.05 V, below the threshold of 25 V; "
      "73.6 V would do");  // 25.74 / 0.35
  EXPECT_TRUE(
      holds(with_fault({InjectFault{fault::kWeak, 1, 0.2}}).message, "no voltage up to 80 V would do"));
  EXPECT_TRUE(holds(with_fault({SetElectrodes{}, InjectFault{fault::kStuckOn, 1}}).message,
                    "is pulled towards channel 1, which is stuck on"));
}

TEST(DropletExplanation, ARailThatIsOffIsCalledByName) {
  EXPECT_EQ(explained(-12, {SetHv{63, 0, false}, SetElectrodes{{1}}}).message,
            "droplet 2 does not move: the rail is disabled; 25.8 V would do");
  EXPECT_EQ(explained(-12, {SetHv{63, 0, true}, Halt{"over-current"}, SetElectrodes{{1}}}).message,
            "droplet 2 does not move: the rail is halted: over-current; 25.8 V would do");
  EXPECT_EQ(explained(-12, {SetHv{63, 0, true}}).message,
            "droplet 2 does not move: no electrode is actuated");
  EXPECT_EQ(explained(-12, {Halt{}}).message,
            "droplet 2 does not move: the rail is halted: it was commanded");
  EXPECT_TRUE(holds(explained(-12, {SetElectrodeVoltages{{1}, {50}}}).message, "is pulled towards channel 1"))
      << "past the rail";
}

TEST(DropletExplanation, ADropletOnItsElectrodesHasNowhereToGo) {
  EXPECT_EQ(explained(-6, {SetHv{63, 0, true}, SetElectrodes{{1}}}).message,
            "droplet 2 does not move: it sits on channel 1, which is actuated");
  EXPECT_EQ(
      explained(-6, {SetHv{63, 0, true}, SetElectrodes{{1, 2, 3}}}).message,
      "droplet 2 does not move: it sits on channel 1, which is actuated; the next one that is, channel 2, is "
      "0.015 mm away");  // from -1 to 0.5
  EXPECT_EQ(explained(-6, {SetHv{63, 0, false}, SetElectrodes{{1}}}).message,
            "droplet 2 does not move: the rail is disabled");
  const DropletExplanation between = explained(-12, {SetHv{63, 0, true}, SetElectrodes{{0, 1}}});
  EXPECT_NEAR(between.driving_force.norm(), 0, 0.01);
  EXPECT_TRUE(
      holds(between.message, "does not exceed that of the other sides; no voltage up to 80 V would do"))
      << between.message;
  Board board(scene());
  board.apply(SetHv{63, 0, true});
  board.apply(SetElectrodes{{1}});
  EXPECT_EQ(explain_droplet(droplet(-6, 0, 9), board, *scene()).message,
            "droplet 2 does not move: it sits on all actuated electrodes");
}

TEST(DropletExplanation, FrequencyChargingAndProgramsAreToldApart) {
  EXPECT_EQ(
      explained(-12, {SetHv{60, 1e4, true}, SetElectrodes{{1}}}, scene(", cutoff_frequency: 2 kHz")).message,
      "droplet 2 does not move: channel 1 is on at 60 V, which acts as less at 10000 Hz, below the threshold "
      "of 25 V; no voltage up to 80 V would do");
  EXPECT_EQ(explained(-12, {SetHv{63, 0, true}, SetElectrodes{{1}}}, scene(", charging_time: 5")).message,
            "droplet 2 does not move yet: channel 1 is charging");
  EXPECT_TRUE(holds(explained(-12, {SetWettability{{-1e-4, 1e-4}, {110, 70}}}).message,
                    "is on a wettability program"));
}

TEST(DropletExplanation, NeedsADropletOnThePlate) {
  Board board(scene());
  engine::DropletObservation in_the_air;
  in_the_air.id = 7;
  const DropletExplanation result = explain_droplet(in_the_air, board, *scene());
  EXPECT_EQ(result.message, "droplet 7 does not touch the plate");
  EXPECT_FALSE(result.nearest_channel || result.needed_voltage);
  Experiment chip(*scene("", "droplets: [{center: [-18, 0], radius: 4}]\n"), {1, "auto"});
  EXPECT_EQ(refusal([&] { chip.explain_droplet(9); }), "droplet 9 does not exist; droplets are [1]");
}

TEST(DropletExplanation, AgreesWithWhatTheLiquidDoes) {
  const auto travelled = [](double voltage, std::string* message) {
    Experiment chip(*scene("", "droplets: [{center: [-15, 0, 0.5], radius: 5}]\n"), {1, "auto"});
    chip.apply(SetHv{voltage, 0, true});
    chip.apply(SetElectrodes{{1}});
    for (int k = 0; k < 300; ++k) chip.step();
    *message = chip.explain_droplet(1).message;
    const double start = chip.observe()->droplets.at(0).centroid.x();
    for (int k = 0; k < 2000; ++k) chip.step();
    return chip.observe()->droplets.at(0).centroid.x() - start;
  };
  std::string still, moving;
  EXPECT_NEAR(travelled(20, &still), 0, 0.3);
  EXPECT_TRUE(holds(still, "below the threshold"));
  EXPECT_GT(travelled(63, &moving), 1);
  EXPECT_TRUE(holds(moving, "is pulled towards channel 1"));
}

}  // namespace
}  // namespace dmf::chip
