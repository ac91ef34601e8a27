#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "frames.h"
#include "node/convert.h"

namespace dmf::node {
namespace {

class ConvertTest : public ::testing::Test {
 protected:
  chip::Scene scene_ = testing::tiny_scene_in_round_units();  // 20 um, 3e-13 kg, 4 us: 5 m/s
  ConversionContext context_{scene_, 1000, 0.02};
  std::shared_ptr<Frame> frame_ = testing::example_frame(scene_);
};

TEST_F(ConvertTest, StateHoldsSiAndReducedTime) {
  const auto state = to_state(*frame_, context_);
  EXPECT_EQ(state.header.stamp, ros::Time(2, 500000000));
  EXPECT_EQ(state.header.frame_id, "chip");
  EXPECT_EQ(state.scene, "tiny_line");
  EXPECT_EQ(state.seed, 42u);
  EXPECT_EQ(state.run, 3u);
  EXPECT_EQ(state.step, 1200u);
  EXPECT_DOUBLE_EQ(state.time_mdpd, 12);
  EXPECT_DOUBLE_EQ(state.time, 12 * 4e-6);
  EXPECT_DOUBLE_EQ(state.temperature_mdpd, 1.01);
  EXPECT_DOUBLE_EQ(state.target_temperature_mdpd, 1);
  EXPECT_DOUBLE_EQ(state.hv_voltage, 63);
  EXPECT_TRUE(state.hv_enabled);
  EXPECT_EQ(state.droplets, 2u);
  EXPECT_EQ(state.vapour_beads, 1u);
  EXPECT_EQ(state.limited_by, "engine");
  EXPECT_EQ(state.state_hash, "") << "nobody asked for it";
}

TEST_F(ConvertTest, AHaltedRailIsToldEverywhere) {
  frame_->rail = {63, 1000, false, "over-current: channel 2 is shorted"};
  frame_->electrodes[2].disabled = true;
  EXPECT_EQ(to_state(*frame_, context_).halted, "over-current: channel 2 is shorted");
  const auto rail = to_diagnostics(*frame_, context_).status.at(1);
  EXPECT_EQ(rail.level, diagnostic_msgs::DiagnosticStatus::ERROR);
  EXPECT_EQ(rail.message, "halted: over-current: channel 2 is shorted");
  const auto electrodes = to_electrodes(*frame_).electrodes;
  EXPECT_TRUE(electrodes[2].disabled);
  EXPECT_FALSE(electrodes[1].disabled);
}

TEST_F(ConvertTest, CapacitanceNamesItsChannels) {
  CapacitanceNote note;
  note.stamp = 1'500'000'000;
  note.run = 4;
  note.time = 3;
  note.reading = {300, {1e-15, 2e-15, 3e-15, 4e-15}};
  const auto message = to_capacitance(note, context_);
  EXPECT_EQ(message.header.stamp, ros::Time(1, 500000000));
  EXPECT_EQ(message.run, 4u);
  EXPECT_EQ(message.step, 300u);
  EXPECT_DOUBLE_EQ(message.time, 3 * 4e-6);
  EXPECT_EQ(message.channels, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(message.capacitance[2], 3e-15);
}

TEST_F(ConvertTest, AnExplanationIsInSiUnits) {
  const double newton = 3e-13 * 5 * 5 / 2e-5;  // of k_BT / r_c
  chip::DropletExplanation explanation;
  explanation.driving_force = {3, -4};
  explanation.side_forces = {1, 2, -3, 4};
  explanation.opposing_force = 6;
  explanation.channels = {0, 1};
  explanation.nearest_channel = 1;
  explanation.nearest_distance = 2;
  const auto response = to_response(explanation, context_);
  EXPECT_DOUBLE_EQ(response.driving_force.x, 3 * newton);
  EXPECT_DOUBLE_EQ(response.driving_force.y, -4 * newton);
  EXPECT_DOUBLE_EQ(response.driving_force_mdpd, 5);
  EXPECT_DOUBLE_EQ(response.opposing_force, 6 * newton);
  ASSERT_EQ(response.side_forces.size(), 4u);
  EXPECT_DOUBLE_EQ(response.side_forces[2], -3 * newton);
  EXPECT_DOUBLE_EQ(response.nearest_distance, 4e-5);
  EXPECT_TRUE(response.has_nearest_channel);
  EXPECT_TRUE(std::isnan(response.needed_voltage)) << "no voltage would do";
  explanation.needed_voltage = 32;
  explanation.nearest_channel.reset();
  EXPECT_EQ(to_response(explanation, context_).needed_voltage, 32);
  EXPECT_FALSE(to_response(explanation, context_).has_nearest_channel);
}

TEST_F(ConvertTest, HashIsSixteenHexDigits) {
  auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
  snapshot->state_hash = 0xab;
  frame_->snapshot = snapshot;
  EXPECT_EQ(to_state(*frame_, context_).state_hash, "00000000000000ab");
}

TEST_F(ConvertTest, DropletIsInSiUnits) {
  const auto droplets = to_droplets(*frame_, context_).droplets;
  ASSERT_EQ(droplets.size(), 2u);
  const auto& droplet = droplets[0];
  EXPECT_EQ(droplet.id, 5u);
  EXPECT_EQ(droplet.parents, (std::vector<std::uint32_t>{2, 3}));
  EXPECT_EQ(droplet.species, "liquid");
  EXPECT_DOUBLE_EQ(droplet.centroid.z, 3 * 2e-5);
  EXPECT_DOUBLE_EQ(droplet.centroid_mdpd.z, 3);
  EXPECT_DOUBLE_EQ(droplet.velocity.x, 0.5 * 5);
  EXPECT_DOUBLE_EQ(droplet.velocity_mdpd.x, 0.5);
  EXPECT_DOUBLE_EQ(droplet.volume, 10 * 8e-15);
  EXPECT_DOUBLE_EQ(droplet.footprint_area, 7 * 4e-10);
  EXPECT_DOUBLE_EQ(droplet.height, 4 * 2e-5);
  ASSERT_EQ(droplet.footprint.size(), 3u);
  EXPECT_DOUBLE_EQ(droplet.footprint[1].x, 2e-5);
  EXPECT_DOUBLE_EQ(droplet.footprint[1].z, scene_.parameters.domain.lower.z() * 2e-5) << "lies on the plate";
  EXPECT_EQ(droplet.channels, (std::vector<std::uint32_t>{0, 1}));
}

TEST_F(ConvertTest, MicroparticleIsInSiUnits) {
  const double newton = 3e-13 * 5 * 5 / 2e-5;  // of k_BT / r_c
  const auto message = to_microparticles(*frame_, context_);
  EXPECT_EQ(message.step, 1200u);
  ASSERT_EQ(message.microparticles.size(), 1u);
  const auto& body = message.microparticles[0];
  EXPECT_EQ(body.id, 3u);
  EXPECT_DOUBLE_EQ(body.radius, 1.5 * 2e-5);
  EXPECT_DOUBLE_EQ(body.mass, 600 * 3e-13);
  EXPECT_TRUE(body.magnetic);
  EXPECT_DOUBLE_EQ(body.attraction_mdpd, -15);
  EXPECT_DOUBLE_EQ(body.pose.position.z, 1.5 * 2e-5);
  EXPECT_DOUBLE_EQ(body.pose.orientation.y, std::sin(0.5));
  EXPECT_DOUBLE_EQ(body.twist.linear.x, 0.5 * 5);
  EXPECT_DOUBLE_EQ(body.twist.angular.y, 0.25 / 4e-6);
  EXPECT_DOUBLE_EQ(body.position_mdpd.y, 2);
  EXPECT_DOUBLE_EQ(body.velocity_mdpd.x, 0.5);
  EXPECT_DOUBLE_EQ(body.angular_velocity_mdpd.y, 0.25);
  EXPECT_TRUE(body.contact);
  EXPECT_DOUBLE_EQ(body.contact_fraction, 0.75);
  EXPECT_DOUBLE_EQ(body.contact_normal.z, 1);
  EXPECT_DOUBLE_EQ(body.normal_force, 20 * newton);
  EXPECT_DOUBLE_EQ(body.friction_force.x, -2 * newton);
  EXPECT_DOUBLE_EQ(body.drive_force.z, -20 * newton);
  EXPECT_DOUBLE_EQ(body.immersion, 0.9);
  EXPECT_EQ(body.droplet, 5u);
  EXPECT_EQ(body.place, dmf_sim::Microparticle::REAR);
}

TEST_F(ConvertTest, AMicroparticleInTheAirHasNoContactNormal) {
  auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
  snapshot->microparticles[0].contact_fraction = 0.3;
  frame_->snapshot = snapshot;
  const auto body = to_microparticles(*frame_, context_).microparticles.at(0);
  EXPECT_FALSE(body.contact);
  EXPECT_EQ(body.contact_normal.z, 0);
}

TEST_F(ConvertTest, StateTellsTheBodyForces) {
  const auto state = to_state(*frame_, context_);
  EXPECT_EQ(state.microparticles, 1u);
  EXPECT_DOUBLE_EQ(state.gravity.z, -2 * 5 / 4e-6);
  EXPECT_DOUBLE_EQ(state.magnetic.x, 3 * 3e-13 * 5 * 5 / 2e-5);
}

TEST_F(ConvertTest, ARequestedMicroparticleKeepsDefaultsWhereItSaysNothing) {
  dmf_sim::AddMicroparticle::Request request;
  request.x = 1e-5;
  request.radius = 2e-5;
  const chip::AddMicroparticle plain = to_command(request);
  EXPECT_EQ(plain.x, 1e-5);
  EXPECT_EQ(plain.radius, 2e-5);
  EXPECT_FALSE(plain.mass || plain.contact_angle_deg);
  EXPECT_EQ(plain.attraction, -15);
  EXPECT_EQ(plain.static_friction, 0) << "as it stands: frictionless";
  EXPECT_EQ(plain.kinetic_friction, 0.0);
  request.contact_angle_deg = 109;
  request.mass = 1e-12;
  request.points.resize(2);
  request.points[1].z = 3e-5;
  request.static_friction = 0.8;
  request.magnetic = true;
  const chip::AddMicroparticle full = to_command(request);
  EXPECT_EQ(full.contact_angle_deg, 109);
  EXPECT_EQ(full.mass, 1e-12);
  ASSERT_EQ(full.points.size(), 2u);
  EXPECT_EQ(full.points[1].z(), 3e-5);
  EXPECT_EQ(full.static_friction, 0.8);
  EXPECT_TRUE(full.magnetic);
}

TEST_F(ConvertTest, EventsNameTheirMicroparticle) {
  EventNote note;
  note.kind = "picked_up";
  note.after = {5};
  note.microparticle = 3;
  const auto event = to_event(note, context_);
  EXPECT_EQ(event.kind, dmf_sim::Event::PICKED_UP);
  EXPECT_EQ(event.after, (std::vector<std::uint32_t>{5}));
  EXPECT_EQ(event.microparticle, 3u);
}

TEST_F(ConvertTest, AnglesThatWereNotMeasuredAreNan) {
  const auto droplets = to_droplets(*frame_, context_).droplets;
  EXPECT_DOUBLE_EQ(droplets[0].advancing_angle_deg, 100);
  EXPECT_TRUE(std::isnan(droplets[0].receding_angle_deg));
  EXPECT_TRUE(std::isnan(droplets[0].contact_angle_deg));
}

TEST_F(ConvertTest, ElectrodesAreInTheOrderOfTheLayout) {
  const auto message = to_electrodes(*frame_);
  ASSERT_EQ(message.electrodes.size(), 4u);
  for (std::uint32_t channel = 0; channel < 4; ++channel) {
    EXPECT_EQ(message.electrodes[channel].channel, channel);
    EXPECT_EQ(message.electrodes[channel].on != 0, channel == 1);
  }
  EXPECT_DOUBLE_EQ(message.electrodes[1].voltage, 63);
  EXPECT_DOUBLE_EQ(message.electrodes[1].contact_angle_deg, 50);
}

TEST_F(ConvertTest, LayoutIsTrueToSize) {
  const auto layout = to_layout(context_);
  ASSERT_EQ(layout.electrodes.size(), 4u);
  EXPECT_NEAR(layout.electrodes[0].centroid.x, -9 * 2e-5, 1e-12);
  EXPECT_NEAR(layout.electrodes[3].centroid.x, 9 * 2e-5, 1e-12);
  EXPECT_EQ(layout.electrodes[1].neighbours, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_DOUBLE_EQ(layout.gap, 1 * 2e-5);
  EXPECT_DOUBLE_EQ(layout.lower.x, -14 * 2e-5);
  EXPECT_DOUBLE_EQ(layout.time_unit, 4e-6);
  EXPECT_DOUBLE_EQ(layout.max_voltage, 80);
}

TEST_F(ConvertTest, CommandCanBeReadBackFromItsJson) {
  CommandNote note;
  note.index = 2;
  note.time = 5;
  note.record = {500, chip::SetHv{63.123456789012345, 1000, true}};
  const auto message = to_command(note, context_);
  EXPECT_EQ(message.name, "set_hv");
  EXPECT_EQ(message.step, 500u);
  EXPECT_DOUBLE_EQ(message.time, 5 * 4e-6);
  const auto command = std::get<chip::SetHv>(chip::command_from_json(message.json));
  EXPECT_EQ(command.voltage, 63.123456789012345);
  EXPECT_TRUE(command.enabled);
}

TEST_F(ConvertTest, ParticlesAreScaledForTheScreen) {
  const auto cloud = to_particles(*frame_, context_);
  ASSERT_EQ(cloud.width, 4u);
  ASSERT_EQ(cloud.fields.size(), 6u);
  ASSERT_EQ(cloud.data.size(), cloud.row_step);
  const auto number = [&](std::size_t bead, std::size_t field) {
    float value;
    std::memcpy(&value, &cloud.data[bead * cloud.point_step + cloud.fields[field].offset], sizeof value);
    return value;
  };
  const auto integer = [&](std::size_t bead, std::size_t field) {
    std::uint32_t value;
    std::memcpy(&value, &cloud.data[bead * cloud.point_step + cloud.fields[field].offset], sizeof value);
    return value;
  };
  EXPECT_EQ(cloud.fields[2].name, "z");
  EXPECT_FLOAT_EQ(number(0, 2), 3 * 2e-5f * 1000);
  EXPECT_FLOAT_EQ(number(2, 0), -4 * 2e-5f * 1000);
  EXPECT_EQ(cloud.fields[3].name, "id");
  EXPECT_EQ(integer(1, 3), 11u);
  EXPECT_EQ(cloud.fields[4].name, "droplet");
  EXPECT_EQ(integer(3, 4), 0u);
  EXPECT_EQ(cloud.fields[5].name, "speed");
  EXPECT_FLOAT_EQ(number(0, 5), 5 * 5.0f) << "true speed, not scaled: |(3, 4, 0)| r_c/tau";
}

TEST_F(ConvertTest, ParticlesOfAMixtureSayWhichLiquidTheyAre) {
  auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
  snapshot->bead_species = {0, 1, 1, 2};
  frame_->snapshot = snapshot;
  const auto cloud = to_particles(*frame_, context_);
  ASSERT_EQ(cloud.fields.size(), 7u);
  EXPECT_EQ(cloud.fields[6].name, "species");
  ASSERT_EQ(cloud.data.size(), 4 * cloud.point_step);
  for (std::size_t bead = 0; bead < 4; ++bead) {
    std::uint32_t id, species;
    std::memcpy(&id, &cloud.data[bead * cloud.point_step + cloud.fields[3].offset], sizeof id);
    std::memcpy(&species, &cloud.data[bead * cloud.point_step + cloud.fields[6].offset], sizeof species);
    EXPECT_EQ(id, snapshot->bead_ids[bead]);
    EXPECT_EQ(species, snapshot->bead_species[bead]);
  }
}

TEST_F(ConvertTest, TransformsAreScaledForTheScreen) {
  const auto droplets = droplet_transforms(*frame_, context_);
  ASSERT_EQ(droplets.size(), 2u);
  EXPECT_EQ(droplets[0].child_frame_id, "chip/droplet_5");
  EXPECT_DOUBLE_EQ(droplets[0].transform.translation.y, 2 * 2e-5 * 1000);
  EXPECT_DOUBLE_EQ(droplets[0].transform.rotation.w, 1);
  const auto bodies = microparticle_transforms(*frame_, context_);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].child_frame_id, "chip/microparticle_3");
  EXPECT_DOUBLE_EQ(bodies[0].transform.translation.z, 1.5 * 2e-5 * 1000);
  EXPECT_DOUBLE_EQ(bodies[0].transform.rotation.y, std::sin(0.5)) << "turned as the body is";
  const auto fixed = static_transforms(context_, ros::Time(1));
  ASSERT_EQ(fixed.size(), 1u + 4u);
  EXPECT_EQ(fixed[0].child_frame_id, "chip/middle");
  const engine::Domain& domain = scene_.parameters.domain;
  EXPECT_NEAR(fixed[0].transform.translation.z, (domain.lower.z() + domain.upper.z()) / 2 * 2e-5 * 1000,
              1e-9);
  EXPECT_EQ(fixed[4].child_frame_id, "chip/electrode_3");
  EXPECT_NEAR(fixed[4].transform.translation.x, 9 * 2e-5 * 1000, 1e-9);
}

TEST_F(ConvertTest, AChipOfAnySizeFitsTheScreen) {
  for (const double length : {1e-9, 7e-7, 1e-5, 2e-5, 5e-5, 1.3e-4, 1e-3}) {
    scene_.units.length_m = length;
    const double scale = fitting_display_scale(scene_);
    const double shown = scene_.parameters.domain.size().norm() * length * scale;
    EXPECT_LE(shown, 0.9) << length;
    if (scale < 1e6) {
      EXPECT_GT(shown, 0.45) << length;
    }
    const std::string digits = fmt::format("{:.0f}", scale);
    EXPECT_EQ(digits.find_last_not_of('0'), 0u) << "a number to remember: " << digits;
  }
}

TEST_F(ConvertTest, DiagnosticsTellSoundWarmAndHalted) {
  using diagnostic_msgs::DiagnosticStatus;
  auto snapshot = std::make_shared<engine::Snapshot>(*frame_->snapshot);
  snapshot->moving_beads = 10000;
  frame_->snapshot = snapshot;
  EXPECT_EQ(to_diagnostics(*frame_, context_).status.at(0).level, DiagnosticStatus::OK);
  snapshot->temperature = 1.2;
  EXPECT_EQ(to_diagnostics(*frame_, context_).status.at(0).level, DiagnosticStatus::WARN);
  snapshot->moving_beads = 20;  // a handful of beads fluctuates more than that
  EXPECT_EQ(to_diagnostics(*frame_, context_).status.at(0).level, DiagnosticStatus::OK);
  frame_->fault = "bead 3 ran away";
  const auto halted = to_diagnostics(*frame_, context_).status.at(0);
  EXPECT_EQ(halted.level, DiagnosticStatus::ERROR);
  EXPECT_NE(halted.message.find("bead 3"), std::string::npos);
}

TEST_F(ConvertTest, DiagnosticsTellWhatTheNodeTakes) {
  const auto memory = memory_status({1.5, 0.25, 20}, context_);
  EXPECT_EQ(memory.level, diagnostic_msgs::DiagnosticStatus::OK);
  ASSERT_EQ(memory.values.size(), 3u);
  EXPECT_EQ(memory.values[0].key, "in use (MB)");
  EXPECT_DOUBLE_EQ(std::stod(memory.values[0].value), 1.5);
  EXPECT_DOUBLE_EQ(std::stod(memory.values[1].value), 0.25);
  EXPECT_DOUBLE_EQ(std::stod(memory.values[2].value), 20);
}

}  // namespace
}  // namespace dmf::node
