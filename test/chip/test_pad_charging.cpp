#include <gtest/gtest.h>

#include <cmath>

#include "chip/experiment.h"
#include "yaml/units.h"

namespace dmf::chip {
namespace {

// Charging in 0.5 tau, 50 steps: the wall is shown anew every 5 steps. 60 degrees at 63 V, 110 at rest.
const char* const kScene = R"(
domain: {lower: [-20, -8, 0], upper: [20, 8, 10]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  electrowetting:
    {reference_voltage: 63, reference_angle: 60, saturation_angle: 60, max_voltage: 80, charging_time: 0.5}
droplets: [{center: [-12, 0], radius: 2}]
)";

Experiment start() { return Experiment(parse_scene(kScene, "scene.yaml"), {1, "auto"}); }

void run(Experiment& chip, int steps) {
  for (int k = 0; k < steps; ++k) chip.step();
}

std::string state_of(const Experiment& chip) {
  engine::ObserveRequest request;
  request.hash = true;
  return chip.save() + std::to_string(*chip.observe(request)->state_hash);
}

/// cos theta on its way from 110 degrees to 60 after so many steps.
double cosine_after(double steps) {
  const double rest = std::cos(110 * degree);
  return rest + (0.5 - rest) * (1 - std::exp(-steps / 50));
}

double cosine_of(const Experiment& chip, std::size_t pad) {
  return std::cos(chip.electrodes()[pad].contact_angle * degree);
}

TEST(PadCharging, GoesExponentiallyToItsAngleAndArrives) {
  Experiment chip = start();
  run(chip, 7);
  chip.apply(SetHv{63, 0, true});
  chip.apply(SetElectrodes{{1}});
  EXPECT_EQ(chip.electrodes()[1].contact_angle, 110) << "not yet";
  run(chip, 4);  // shown at steps 10, 15, ..., before the step that follows
  EXPECT_NEAR(cosine_of(chip, 1), cosine_after(3), 1e-12);
  EXPECT_NEAR(chip.commanded_angle(0, 0), chip.electrodes()[1].contact_angle, 1e-12);
  run(chip, 50);
  EXPECT_NEAR(cosine_of(chip, 1), cosine_after(53), 1e-12);
  EXPECT_EQ(chip.electrodes()[0].contact_angle, 110);
  // Within 0.05 degrees of its end after ln(0.842 / (0.05 * pi / 180 * sin 60)) = 7.0 charging times.
  run(chip, 280);
  EXPECT_NE(chip.electrodes()[1].contact_angle, 60);
  run(chip, 20);
  EXPECT_NEAR(chip.electrodes()[1].contact_angle, 60, 1e-12);
}

TEST(PadCharging, ACommandInBetweenFindsThePadWhereItIs) {
  Experiment chip = start();
  chip.apply(SetHv{63, 0, true});
  chip.apply(SetElectrodes{{1}});
  run(chip, 23);
  chip.apply(SetElectrodes{{2}});
  EXPECT_NEAR(cosine_of(chip, 1), cosine_after(23), 1e-12) << "not where it was last shown";
  run(chip, 8);
  const double rest = std::cos(110 * degree);
  EXPECT_NEAR(cosine_of(chip, 1), rest + (cosine_after(23) - rest) * std::exp(-7. / 50), 1e-12);
  EXPECT_NEAR(cosine_of(chip, 2), cosine_after(7), 1e-12);
}

TEST(PadCharging, AboveSaturationItIsNoSlowerToLeave) {
  Experiment chip = start();
  chip.apply(SetHv{80, 0, true});
  chip.apply(SetElectrodes{{1}});
  run(chip, 600);
  EXPECT_EQ(chip.electrodes()[1].contact_angle, 60);
  chip.apply(SetElectrodes{});
  run(chip, 11);
  const double rest = std::cos(110 * degree);
  EXPECT_NEAR(cosine_of(chip, 1), rest + (0.5 - rest) * std::exp(-10. / 50), 1e-12);
}

TEST(PadCharging, ASavedRunGoesOnWithTheSameBits) {
  Experiment chip = start();
  run(chip, 3);
  chip.apply(SetHv{70.0 / 3, 0, true});
  chip.apply(SetElectrodes{{0, 1}});
  run(chip, 9);
  const std::string saved = chip.save();
  Experiment other = start();
  run(other, 2);
  other.load(saved);
  EXPECT_TRUE(state_of(other) == state_of(chip));
  for (Experiment* each : {&chip, &other}) {
    run(*each, 4);
    each->apply(SetElectrodes{{1}});
    run(*each, 300);
  }
  EXPECT_TRUE(state_of(other) == state_of(chip));
  EXPECT_EQ(other.electrodes()[1].contact_angle, chip.electrodes()[1].contact_angle);
  Experiment again = start();
  for (const auto& [step, command] : chip.history()) {
    while (again.steps() < step) again.step();
    again.apply(command);
  }
  while (again.steps() < chip.steps()) again.step();
  EXPECT_TRUE(state_of(again) == state_of(chip));
}

TEST(PadCharging, ASavedRunWhosePadsHaveArrivedKeepsThemThere) {
  Experiment chip = start();
  chip.apply(SetHv{63, 0, true});
  chip.apply(SetElectrodes{{1}});
  run(chip, 600);
  Experiment other = start();
  other.load(chip.save());
  EXPECT_EQ(other.electrodes()[1].contact_angle, chip.electrodes()[1].contact_angle);
  for (Experiment* each : {&chip, &other}) {
    each->apply(SetElectrodes{});
    run(*each, 30);
  }
  EXPECT_TRUE(state_of(other) == state_of(chip));
}

TEST(PadCharging, ADamagedChargeIsRefused) {
  Experiment chip = start();
  chip.apply(SetHv{63, 0, true});
  chip.apply(SetElectrodes{{1}});
  run(chip, 9);
  std::string saved = chip.save();
  const std::string before = state_of(chip);
  const auto place = saved.find("\"numbers\":[");
  ASSERT_NE(place, std::string::npos);
  for (const char* damage : {"\"numbers\":[7.0,", "\"numbers\":[-1.0,", "\"numbers\":[0.0,0.0,"}) {
    std::string damaged = saved;
    damaged.replace(place, std::string("\"numbers\":[0.0,").size(), damage);
    EXPECT_THROW(chip.load(damaged), engine::InvalidInput) << damage;
    EXPECT_TRUE(state_of(chip) == before);
  }
}

}  // namespace
}  // namespace dmf::chip
