#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "chip/command.h"
#include "chip/command_reader.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

AddMicroparticle sphere() {
  AddMicroparticle command;
  command.x = -1e-5 / 3;
  command.y = 1e-4;
  command.height = 1e-6 / 7;
  command.radius = 1e-5;
  command.beads = 612;
  command.smooth = true;
  command.contact_angle_deg = 109.1;
  command.kinetic_friction = 0.1 + 0.2;
  command.magnetic = true;
  return command;
}

AddMicroparticle dumbbell() {
  AddMicroparticle command;
  command.radius = 1e-5;
  command.points = {{-1e-5 / 3, 0, 0}, {1e-5 / 3, 0, 0.1}};
  command.mass = 1e-13 / 3;
  command.attraction = -20;
  return command;
}

std::vector<Command> one_of_each() {
  return {SetElectrodes{{0, 4294967295u}},
          SetElectrodes{},
          SetHv{63.000000000000007, 1e3, true},
          SetElectrodeVoltages{{1, 2}, {0.1, 5e-324}},
          SetWettability{{-4e-4, 1.0 / 3e3}, {150, 40.1}},
          LoadPattern{"for\"ward\n\xc3\xa4 \x01"},
          DispenseDroplet{-1e-5 / 3, 2e-4, 4.1887902047863905e-15},
          DispenseDroplet{0, 0, 0, 1.5, "oil \"heavy\""},
          Remove{7},
          Reset{},
          sphere(),
          dumbbell(),
          Remove{0, 3},
          SetBodyForces{{0, 1.0 / 3, -9.81}, {1e-9 / 3, 0, -0.0}},
          InjectFault{fault::kStuckOn, 4294967295u},
          InjectFault{fault::kWeak, 3, 0.1 + 0.2},
          InjectFault{fault::kDisconnected},
          InjectFault{fault::kClear, 2},
          InjectFault{fault::kClear, 0, 1, true},
          SetDisabledChannels{{5, 2}},
          SetDisabledChannels{},
          Halt{},
          Halt{"over-current: 0.1 A"}};
}

TEST(CommandJson, RoundTripsToTheLastBit) {
  for (const Command& command : one_of_each()) {
    const std::string json = to_json(command);
    const Command back = command_from_json(json);
    EXPECT_EQ(back.index(), command.index()) << json;
    EXPECT_EQ(to_json(back), json);
  }
  const auto voltages = std::get<SetElectrodeVoltages>(command_from_json(to_json(one_of_each()[3]))).voltages;
  EXPECT_EQ(voltages, (std::vector<double>{0.1, 5e-324}));
  const auto dispense = std::get<DispenseDroplet>(command_from_json(to_json(one_of_each()[6])));
  EXPECT_EQ(dispense.x, -1e-5 / 3);
  EXPECT_EQ(dispense.volume, 4.1887902047863905e-15);
  EXPECT_EQ(dispense.species, "");
  EXPECT_EQ(std::get<DispenseDroplet>(command_from_json(to_json(one_of_each()[7]))).species, "oil \"heavy\"");
  EXPECT_EQ(std::get<LoadPattern>(command_from_json(to_json(one_of_each()[5]))).name,
            "for\"ward\n\xc3\xa4 \x01");
}

TEST(CommandJson, AMicroparticleKeepsWhatWasLeftToItsDefaults) {
  const auto ball = std::get<AddMicroparticle>(command_from_json(to_json(sphere())));
  EXPECT_EQ(ball.x, sphere().x);
  EXPECT_EQ(ball.height, sphere().height);
  EXPECT_EQ(ball.contact_angle_deg, 109.1);
  EXPECT_EQ(ball.kinetic_friction, 0.1 + 0.2);
  EXPECT_FALSE(ball.mass);
  EXPECT_TRUE(ball.points.empty());
  EXPECT_TRUE(ball.magnetic && ball.smooth);
  const auto body = std::get<AddMicroparticle>(command_from_json(to_json(dumbbell())));
  EXPECT_EQ(body.points, dumbbell().points);
  EXPECT_EQ(body.mass, 1e-13 / 3);
  EXPECT_EQ(body.attraction, -20);
  EXPECT_EQ(body.beads, 0u);
  EXPECT_FALSE(body.contact_angle_deg || body.kinetic_friction);
}

TEST(CommandJson, LooksAsDocumented) {
  EXPECT_EQ(to_json(SetHv{63, 1000, true}),
            R"({"command":"set_hv","voltage":63.0,"frequency":1000.0,"enabled":true})");
  EXPECT_EQ(to_json(Reset{}), R"({"command":"reset"})");
  EXPECT_EQ(to_json(Remove{0, 3}), R"({"command":"remove","microparticle":3})");
  EXPECT_EQ(to_json(SetBodyForces{{0, 0, -9.81}, {}}),
            R"({"command":"set_body_forces","gravity":[0.0,0.0,-9.81],"magnetic":[0.0,0.0,0.0]})");
  EXPECT_EQ(to_json(InjectFault{fault::kWeak, 3, 0.5}),
            R"({"command":"inject_fault","kind":"weak","channel":3,"strength":0.5})");
  EXPECT_EQ(to_json(InjectFault{fault::kClear, 0, 1, true}),
            R"({"command":"inject_fault","kind":"clear","all":true})");
  EXPECT_EQ(to_json(Halt{}), R"({"command":"halt"})");
}

TEST(CommandJson, EveryCommandHasTheNameOfItsService) {
  const auto commands = one_of_each();
  for (const std::string& name : command_names()) {
    const auto named = [&name](const Command& command) { return name_of(command) == name; };
    EXPECT_TRUE(std::any_of(commands.begin(), commands.end(), named)) << name;
  }
  EXPECT_EQ(command_names().size(), std::variant_size_v<Command>);
}

TEST(CommandJson, WhatIsWrongIsNamed) {
  const auto refused = [](const char* json) { return refusal([json] { command_from_json(json); }); };
  EXPECT_TRUE(holds(refused(R"({"command":"set_hv","frequency":0})"), "voltage: missing"));
  EXPECT_TRUE(
      holds(refused(R"({"command":"set_hv","voltage":null})"), "voltage: nothing, allowed: a finite number"));
  EXPECT_TRUE(holds(refused(R"({"command":"fly"})"), "command: fly, allowed: set_electrodes, set_hv"));
  EXPECT_TRUE(holds(refused(R"({"voltage":5})"), "command: missing"));
  EXPECT_TRUE(holds(refused(R"({"command":"remove","droplet":1,"fast":true})"), "fast: unknown key"));
  EXPECT_TRUE(holds(refused(R"({"command":"remove","droplet":1,"microparticle":1})"),
                    "microparticle: given together with droplet"));
  EXPECT_TRUE(holds(refused(R"({"command":"set_body_forces","gravity":[0,1]})"),
                    "gravity: a list of 2, allowed: a list of 3"));
  EXPECT_TRUE(
      holds(refused(R"({"command":"set_electrodes","channels":[-1]})"), "channels[0]: -1, allowed: a whole"));
  EXPECT_TRUE(holds(refused(R"({"command":"inject_fault","kind":"melted"})"),
                    "kind: melted, allowed: stuck_on, stuck_off, short, weak, disconnected, clear"));
  EXPECT_TRUE(holds(refused(R"({"command":"inject_fault","kind":"weak","channel":1})"), "strength: missing"));
  EXPECT_TRUE(holds(refused(R"({"command":"inject_fault","kind":"stuck_on"})"), "channel: missing"));
  EXPECT_TRUE(holds(refused(R"({"command":"inject_fault","kind":"short","channel":1,"all":true})"),
                    "all: unknown key"));
  EXPECT_TRUE(holds(refused("{"), "is not YAML"));
}

}  // namespace
}  // namespace dmf::chip
