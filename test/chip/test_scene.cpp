#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "chip/configuration.h"
#include "chip/scene.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

const char* const kChip = R"(
domain: {lower: [-20, -10, 0], upper: [20, 10, 20]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  electrowetting: {reference_angle: 60, saturation_angle: 55}
)";

Scene parse(const std::string& more) { return parse_scene(kChip + more, "scene.yaml"); }
std::string refused(const std::string& more) {
  return refusal([&] { parse(more); });
}

TEST(ShippedScenes, AllLoad) {
  for (const char* name :
       {"droplet_gradient", "gradient_R5", "sessile", "electrode_line", "electrode_array", "delivery_line"}) {
    const Scene scene = load_scene(name);
    EXPECT_EQ(scene.name, name);
    EXPECT_FALSE(scene.description.empty()) << name;
    EXPECT_FALSE(scene.droplets.empty()) << name;
    EXPECT_GT(scene.default_duration, scene.settle_time) << name;
  }
}

TEST(ShippedScenes, SoDoesEveryOtherFileInTheirFolders) {
  for (const char* folder : {DMF_SOURCE_DIR "/config/scenes", DMF_SOURCE_DIR "/test/scenes"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      EXPECT_NO_THROW(load_scene(entry.path().string())) << entry.path();
    }
  }
}

TEST(ShippedScenes, GradientIsLans) {
  const Scene scene = load_scene("gradient_R5");
  ASSERT_EQ(scene.droplets.size(), 1u);
  EXPECT_TRUE(scene.droplets[0].center.isApprox(Eigen::Vector3d(-40, 0, -5)))
      << "touches the wall at z = -10";
  EXPECT_EQ(scene.settle_time / scene.parameters.time_step, 2000);
  const auto& program = std::get<SetWettability>(scene.schedule.at(0).command);
  EXPECT_DOUBLE_EQ(program.positions[1], 40 * scene.units.length_m);
  EXPECT_EQ(program.contact_angles_deg, (std::vector<double>{150, 40}));
}

TEST(ShippedScenes, ArrayLooksAsItsCommentDraws) {
  const Scene scene = load_scene("electrode_array");
  EXPECT_EQ(scene.layout.channels_text(), "0-14, 16-23");
  EXPECT_EQ(scene.layout.overlapping({{-26, -16}, {-24, -16}, {-25, -14}}).at(0), scene.layout.index_of(0));
  const auto& top_right = scene.layout.electrodes()[scene.layout.index_of(23)];
  EXPECT_TRUE(top_right.centroid.isApprox(scene.droplets[1].center.head<2>()));
}

TEST(Scene, UnitsAreWatersByDefaultAndLansOnDemand) {
  const engine::Units water = parse("").units;
  EXPECT_DOUBLE_EQ(water.length_m, 1e-5);
  EXPECT_NEAR(water.surface_tension_N_per_m() * engine::LiquidParameters{}.surface_tension, 0.072, 1e-12);
  EXPECT_NEAR(engine::LiquidParameters{}.bulk_density * water.mass_kg / 1e-15, 1000, 1e-9);
  EXPECT_DOUBLE_EQ(parse("units: {preset: lan2016}\n").units.time_s, 8.5e-6);
  EXPECT_TRUE(
      holds(refused("units: {length: 10}\n"), "units.length: 10, allowed: [1e-09, 0.01] m, with a unit"));
  EXPECT_TRUE(holds(refused("units: {length: 10 ms}\n"),
                    "units.length: 10 ms, allowed: [1e-09, 0.01] m, with a unit"));
}

TEST(Scene, TheSameLengthInAnyUnitIsTheSame) {
  const Scene reduced = parse("droplets: [{center: [-12, 0], radius: 5}]\n");
  const Scene metric = parse("droplets: [{center: [-0.12 mm, 0 um], radius: 50 um}]\n");
  const Scene by_volume = parse("droplets: [{center: [-12, 0], volume: 0.5235987755982989 nl}]\n");
  for (const Scene* scene : {&metric, &by_volume}) {
    EXPECT_NEAR(scene->droplets[0].radius, reduced.droplets[0].radius, 1e-12);
    EXPECT_TRUE(scene->droplets[0].center.isApprox(reduced.droplets[0].center, 1e-12));
  }
}

TEST(Scene, EverythingWrongIsToldAtOnceWithFileAndLine) {
  const std::string text = refusal([] {
    parse_scene(
        "domain: {lower: [0, 0, 0], upper: [20, 20, 2]}\n"
        "time_step: 5 mm\n"
        "liquid: {atraction: -40}\n"
        "integrator_lambda: 0.1\n"
        "droplets:\n"
        "  - {center: [0], radius: 5}\n"
        "  - {center: [10, 10], radius: 1, volume: 1 nl}\n"
        "schedule:\n"
        "  - {at: 1, set_electrodes: {channel: [1]}}\n"
        "  - {at: -1}\n"
        "  - {at: 1, reset: {}}\n"
        "patterns: {p: [{at: 0, load_pattern: {name: p}}]}\n",
        "bad.yaml");
  });
  EXPECT_TRUE(holds(text, "bad.yaml:1: domain.z: 2 long, allowed: 3 to 4000"));
  EXPECT_TRUE(
      holds(text, "bad.yaml:2: time_step: 5 mm, allowed: a finite number tau (units: s, ms, us, ns)"));
  EXPECT_TRUE(holds(text, "bad.yaml:3: liquid.atraction: unknown key, did you mean `attraction`?"));
  EXPECT_TRUE(holds(text, "bad.yaml:4: integrator_lambda: 0.1, allowed: 0.5 to 1"));
  EXPECT_TRUE(holds(text, "bad.yaml:6: droplets[0].center: a list of 1, allowed: a list of 2 to 3 numbers"));
  EXPECT_TRUE(holds(text, "bad.yaml:7: droplets[1].volume: given together with radius"));
  EXPECT_TRUE(holds(text, "bad.yaml:9: schedule[0].set_electrodes.channels: missing"));
  EXPECT_TRUE(
      holds(text, "bad.yaml:9: schedule[0].set_electrodes.channel: unknown key, did you mean `channels`?"));
  EXPECT_TRUE(holds(text, "bad.yaml:10: schedule[1].at: -1, allowed: at least 0 tau"));
  EXPECT_TRUE(holds(text, "bad.yaml:10: schedule[1]: 0 commands, allowed: one of set_electrodes"));
  EXPECT_TRUE(holds(text, "bad.yaml:11: schedule[2].reset: unknown key"));
  EXPECT_TRUE(holds(text, "bad.yaml:12: patterns.p[0].load_pattern: unknown key"));
}

TEST(Scene, ChoosesTheIntegrator) {
  EXPECT_EQ(parse("").parameters.integrator, engine::Integrator::groot_warren);
  EXPECT_EQ(parse("integrator: baoab\n").parameters.integrator, engine::Integrator::baoab);
  EXPECT_TRUE(holds(refused("integrator: euler\n"), "integrator: euler, allowed: groot_warren, baoab"));
}

TEST(Scene, AMicroparticleIsLansUnlessToldOtherwise) {
  const Scene scene = parse("microparticles: [{center: [-15, 0], radius: 1}]\n");
  ASSERT_EQ(scene.microparticles.size(), 1u);
  const engine::MicroparticlePlacement& body = scene.microparticles[0];
  EXPECT_EQ(body.center, Eigen::Vector2d(-15, 0));
  EXPECT_FALSE(body.z) << "it rests on the wall";
  EXPECT_FALSE(body.smooth);
  EXPECT_TRUE(
      parse("microparticles: [{center: [-15, 0], radius: 1, smooth: true}]\n").microparticles[0].smooth);
  EXPECT_EQ(body.attraction, -15);
  EXPECT_EQ(body.static_friction, 0.2);
  EXPECT_FALSE(body.kinetic_friction) << "equal to the static one";
  EXPECT_EQ(body.rolling_friction, 0.1);
  EXPECT_EQ(scene.parameters.microparticles.contact, engine::ContactModel::lan2016);
  EXPECT_TRUE(scene.body_forces.gravity.isZero(0) && scene.body_forces.magnetic.isZero(0));
}

TEST(Scene, AMicroparticleSaysItsShapeSurfaceMassAndFriction) {
  const Scene scene = parse(
      "microparticles:\n"
      "  - {center: [-15, 0, 2], radius: 10 um, beads: 312, contact_angle: 109 deg, mass: 500, "
      "static_friction: 0.8, kinetic_friction: 0.6, rolling_friction: 0.4, magnetic: true}\n"
      "  - {center: [15, 0], radius: 0.5, points: [[-1, 0, 0], [10 um, 0, 0]], attraction: -20}\n"
      "microparticle_model: {contact: coulomb, elastic_modulus: 1e5, wall_attraction: -2, "
      "liquid_repulsion: 4, particle_adhesion: 50, counts_own_beads: false, counts_liquid: false, "
      "counted_by_liquid: false, calibration: lan2016}\n");
  ASSERT_EQ(scene.microparticles.size(), 2u);
  const engine::MicroparticlePlacement& sphere = scene.microparticles[0];
  EXPECT_EQ(sphere.z, 2);
  EXPECT_NEAR(sphere.radius, 1, 1e-12);
  EXPECT_EQ(sphere.beads, 312u);
  EXPECT_DOUBLE_EQ(sphere.attraction, engine::ContactAngleCurve::lan2016().attraction(109));
  EXPECT_EQ(sphere.mass, 500);
  EXPECT_EQ(sphere.static_friction, 0.8);
  EXPECT_EQ(sphere.kinetic_friction, 0.6);
  EXPECT_EQ(sphere.rolling_friction, 0.4);
  EXPECT_TRUE(sphere.magnetic);
  const engine::MicroparticlePlacement& dumbbell = scene.microparticles[1];
  ASSERT_EQ(dumbbell.points.size(), 2u);
  EXPECT_TRUE(dumbbell.points[1].isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_EQ(dumbbell.attraction, -20);
  const engine::MicroparticleParameters& model = scene.parameters.microparticles;
  EXPECT_EQ(model.contact, engine::ContactModel::coulomb);
  EXPECT_EQ(model.elastic_modulus, 1e5);
  EXPECT_EQ(model.wall_attraction, -2);
  EXPECT_EQ(model.liquid_repulsion, 4);
  EXPECT_EQ(model.particle_adhesion, 50);
  EXPECT_FALSE(model.counts_own_beads || model.counts_liquid || model.counted_by_liquid);
}

TEST(Scene, BodyForcesMayBeWrittenInSi) {
  const Scene scene = parse("body_forces: {gravity: [0, 0, -9.81 m/s^2], magnetic: [1 nN, 0, -2]}\n");
  const double tau = scene.units.time_s, r_c = scene.units.length_m;
  EXPECT_NEAR(scene.body_forces.gravity.z() * r_c / (tau * tau), -9.81, 1e-12);
  EXPECT_NEAR(scene.body_forces.magnetic.x() * scene.units.force_N(), 1e-9, 1e-21);
  EXPECT_EQ(scene.body_forces.magnetic.z(), -2);
  EXPECT_TRUE(parse("body_forces: {magnetic: [0, 0, 1]}\n").body_forces.gravity.isZero(0));
}

TEST(Scene, EverythingWrongWithMicroparticlesIsToldAtOnce) {
  const std::string text = refused(
      "microparticles:\n"
      "  - {center: [-15, 0], raduis: 1}\n"
      "  - {center: [1], radius: 0, mass: 5 m}\n"
      "  - {center: [15, 0], radius: 1, beads: 612, points: [[0, 0]]}\n"
      "  - {center: [15, 0], radius: 1, attraction: -15, contact_angle: 20}\n"
      "microparticle_model: {contact: hertz, calibration: nope}\n"
      "body_forces: {gravity: [0, -9.81 m], magnetic: [0, 0, 1 m/s^2]}\n");
  EXPECT_TRUE(holds(text, "scene.yaml:9: microparticles[0].radius: missing"));
  EXPECT_TRUE(holds(text, "scene.yaml:9: microparticles[0].raduis: unknown key, did you mean `radius`?"));
  EXPECT_TRUE(holds(text, "scene.yaml:10: microparticles[1].center: a list of 1, allowed: a list of 2 to 3"));
  EXPECT_TRUE(holds(text, "scene.yaml:10: microparticles[1].radius: 0, allowed: more than 0 r_c"));
  EXPECT_TRUE(holds(text, "scene.yaml:10: microparticles[1].mass: 5 m, allowed: a finite number beads"));
  EXPECT_TRUE(holds(text, "scene.yaml:11: microparticles[2].beads: given together with points"));
  EXPECT_TRUE(holds(text, "scene.yaml:11: microparticles[2].points[0]: a list of 2"));
  EXPECT_TRUE(holds(text, "scene.yaml:12: microparticles[3].contact_angle: given together with attraction"));
  EXPECT_TRUE(holds(text, "scene.yaml:13: microparticle_model.contact: hertz, allowed: lan2016, coulomb"));
  EXPECT_TRUE(holds(text, "scene.yaml:13: microparticle_model.calibration: nope: there is no such file"));
  EXPECT_TRUE(holds(text, "scene.yaml:14: body_forces.gravity: a list of 2, allowed: a list of 3 numbers"));
  EXPECT_TRUE(holds(text, "scene.yaml:14: body_forces.magnetic[2]: 1 m/s^2, allowed: a finite number"));
  EXPECT_TRUE(holds(refused("microparticles: [{center: [15, 0], radius: 1, contact_angle: 20}]\n"),
                    "scene.yaml:8: microparticles[0].contact_angle: contact angle: 20 degrees, allowed: 40"));
}

TEST(Scene, CommandsAreHeldToWhatTheChipCanDo) {
  const std::string text = refused(
      "schedule:\n"
      "  - {at: 0, set_electrodes: {channels: [9, 1, 1]}}\n"
      "  - {at: 0, set_hv: {voltage: 120, frequency: 1 V}}\n");
  EXPECT_TRUE(holds(text, "frequency: 1 V, allowed")) << "types are told before what commands mean";
  const std::string meaning = refused(
      "schedule:\n"
      "  - {at: 0, set_electrodes: {channels: [9, 1, 1]}}\n"
      "  - {at: 0, set_hv: {voltage: 120}}\n"
      "patterns:\n"
      "  p:\n"
      "    - {at: 0, set_wettability: {positions: [0, 0, 30], contact_angles: [100, 20]}}\n"
      "    - {at: 0, dispense_droplet: {x: 18, y: 0, radius: 5}}\n");
  EXPECT_TRUE(
      holds(meaning, "scene.yaml:9: schedule[0].set_electrodes: channel 9 does not exist; channels are 0-2"));
  EXPECT_TRUE(holds(meaning, "scene.yaml:9: schedule[0].set_electrodes: channels: 1 given twice"));
  EXPECT_TRUE(holds(meaning, "scene.yaml:10: schedule[1].set_hv: voltage 120 V: allowed 0 to 80 V"));
  EXPECT_TRUE(holds(meaning,
                    "scene.yaml:13: patterns.p[0].set_wettability: positions: 3 given but 2 contact angles"));
  EXPECT_TRUE(
      holds(meaning, "position 0.3 mm (30 r_c): allowed -0.2 mm (-20 r_c) to 0.2 mm (20 r_c), the plate"));
  EXPECT_TRUE(holds(meaning, "contact angle 20 degrees: allowed 40 to 150 degrees"));
  EXPECT_TRUE(holds(meaning, "scene.yaml:14: patterns.p[1].dispense_droplet: centre's x"));
}

TEST(Scene, ElectrodesAndDropletsStayOnThePlate) {
  EXPECT_TRUE(holds(refused("droplets: [{center: [17, 0], radius: 5}]\n"),
                    "scene.yaml:8: droplets[0]: centre's x 0.17 mm (17 r_c): allowed"));
  EXPECT_TRUE(holds(refused("droplets: [{center: [0, 0], radius: 3}, {center: [6.5, 0], radius: 3}]\n"),
                    "droplets[1]: 0.5 r_c from another droplet, allowed: 1 r_c or more"));
  EXPECT_TRUE(
      holds(refused("droplets: [{center: [0, 0], radius: 15}]\n"), "radius 0.15 mm (15 r_c): allowed up to"));
  const std::string text = refusal([] {
    parse_scene(
        "domain: {lower: [0, 0, 0], upper: [20, 20, 20]}\n"
        "chip:\n"
        "  gap: 1\n"
        "  polygons:\n"
        "    - {channel: 4, outline: [[1, 1], [9, 1], [5, 8]]}\n"
        "    - {channel: 5, outline: [[11, 1], [21, 1], [15, 8]]}\n",
        "scene.yaml");
  });
  EXPECT_TRUE(
      holds(text, "chip: channel 5: x 11 to 21, y 1 to 8 r_c, allowed: inside the domain, x 0 to 20"));
  EXPECT_EQ(text.find("channel 4"), std::string::npos);
}

TEST(Scene, AnglesStayWithinTheCalibration) {
  EXPECT_TRUE(holds(refusal([] {
                      parse_scene(
                          "domain: {lower: [0, 0, 0], upper: [20, 20, 20]}\nwettability: {calibration: "
                          "lan2016, rest_angle: 160}\n",
                          "scene.yaml");
                    }),
                    "scene.yaml:2: wettability.rest_angle: 160 degrees, allowed: 40 to 150 degrees"));
  std::string low = kChip;
  low.replace(low.find("saturation_angle: 55"), 20, "saturation_angle: 20");
  EXPECT_TRUE(holds(refusal([&] { parse_scene(low, "scene.yaml"); }),
                    "chip.electrowetting.max_voltage: 80 V leads to"));
}

TEST(Scene, ElectrowettingAndLayoutAreCheckedWhereTheyStand) {
  EXPECT_TRUE(holds(refusal([] {
                      parse_scene(
                          "domain: {lower: [0, 0, 0], upper: [20, 20, 20]}\n"
                          "chip:\n"
                          "  gap: 2\n"
                          "  grids: [{origin: [9, 9], columns: 1, rows: 1, pitch: 1}]\n"
                          "  electrowetting: {reference_angle: 10, max_voltage: -1}\n",
                          "s.yaml");
                    }),
                    "s.yaml:4: chip.grids[0]: pitch: 1 r_c, allowed: more than the gap, 2 r_c\n"
                    "s.yaml:5: chip.electrowetting: reference_angle: 10, allowed"));
}

std::string with_electrowetting(const std::string& keys) {
  std::string text = kChip;
  const std::string old = "reference_angle: 60, saturation_angle: 55";
  return text.replace(text.find(old), old.size(), keys);
}

TEST(Scene, ADielectricStandsForTheReferencePoint) {
  const Scene scene = parse_scene(
      with_electrowetting("dielectric: {relative_permittivity: 3, thickness: 1 um}, saturation_angle: 60, "
                          "threshold_voltage: 10 V, cutoff_frequency: 10 kHz, breakdown_voltage: 75, "
                          "charging_time: 1 us"),
      "scene.yaml");
  const Electrowetting& law = scene.electrowetting;
  // eta = 8.8541878e-12 * 3 * (50^2 - 10^2) / (2 * 0.072 * 1e-6) = 0.442709 again.
  EXPECT_NEAR(law.number(50), 0.442709, 1e-6);
  EXPECT_NEAR(law.dielectric_capacitance(surface_tension(scene)), 8.8541878e-12 * 3 / 1e-6, 1e-10);
  EXPECT_EQ(law.cutoff_frequency, 1e4);
  EXPECT_EQ(law.breakdown_voltage, 75);
  EXPECT_NEAR(law.charging_time * scene.units.time_s, 1e-6, 1e-18);
}

TEST(Scene, WhatIsWrongWithElectrowettingIsTold) {
  const auto refused_law = [](const std::string& keys) {
    return refusal([&] { parse_scene(with_electrowetting(keys), "scene.yaml"); });
  };
  const std::string both = refused_law(
      "reference_voltage: 60, dielectric: {relative_permittivity: 3, thickness: 1 um}, saturation_angle: 60");
  EXPECT_TRUE(holds(both, "chip.electrowetting.reference_voltage: given together with dielectric"));
  const std::string dielectric = refused_law("dielectric: {relative_permittivity: 0.5, thickness: 0}");
  EXPECT_TRUE(holds(dielectric, "relative_permittivity: 0.5, allowed: [1, 100000]"));
  EXPECT_TRUE(holds(dielectric, "thickness: 0, allowed: more than 0 r_c"));
  EXPECT_TRUE(holds(refused_law("dielectric: {}"), "thickness: missing"));
  EXPECT_TRUE(holds(refused_law("reference_angle: 60, saturation_angle: 55, threshold_voltage: 70"),
                    "threshold_voltage: 70, allowed: [0, 63) V"));
  EXPECT_TRUE(holds(refused_law("saturation_angle: 60, threshold_voltage: 80, "
                                "dielectric: {relative_permittivity: 3, thickness: 1 um}"),
                    "threshold_voltage: 80, allowed: [0, 80) V"));
}

TEST(Scene, ScheduleIsPlayedByRisingTime) {
  const Scene scene = parse(
      "schedule:\n  - {at: 5, set_electrodes: {channels: [1]}}\n  - {at: 2, set_hv: {voltage: 10}}\n"
      "  - {at: 5, set_electrodes: {channels: [2]}}\n");
  ASSERT_EQ(scene.schedule.size(), 3u);
  EXPECT_EQ(name_of(scene.schedule[0].command), "set_hv");
  EXPECT_EQ(std::get<SetElectrodes>(scene.schedule[2].command).channels[0], 2u)
      << "as written at equal times";
}

TEST(Scene, ANameThatIsNotThereIsAnsweredWithThoseThatAre) {
  const std::string text = refusal([] { load_scene("electrode_lines"); });
  EXPECT_TRUE(holds(text, "did you mean electrode_line?"));
  EXPECT_TRUE(holds(text, "droplet_gradient"));
  EXPECT_TRUE(holds(refused("wettability: {}\n"), "wettability: given twice"));
  EXPECT_TRUE(holds(refusal([] {
                      parse_scene(
                          "domain: {lower: [0, 0, 0], upper: [9, 9, 9]}\nwettability: {calibration: nope}\n",
                          "scene.yaml");
                    }),
                    "scene.yaml:2: wettability.calibration: nope: there is no such file"));
}

/// A config directory of its own, through the environment.
class OtherConfig : public ::testing::Test {
 protected:
  void SetUp() override {
    char folder[] = "/tmp/dmf_config_XXXXXX";
    ASSERT_NE(mkdtemp(folder), nullptr);
    directory_ = folder;
    std::filesystem::create_directories(directory_ / "scenes");
    std::filesystem::create_directories(directory_ / "calibration");
    setenv("DMF_SIM_CONFIG", folder, 1);
  }
  void TearDown() override {
    unsetenv("DMF_SIM_CONFIG");
    std::filesystem::remove_all(directory_);
  }
  void write(const std::string& file, const std::string& text) { std::ofstream(directory_ / file) << text; }

  std::filesystem::path directory_;
};

TEST_F(OtherConfig, IsFoundThroughTheEnvironment) {
  write("calibration/mine.yaml", "description: d\ncommand: c\npoints: [[-20, 60, 1], [-10, 120, 1]]\n");
  write("scenes/small.yaml",
        "domain: {lower: [0, 0, 0], upper: [9, 9, 9]}\nwettability: {calibration: mine, rest_angle: 110}\n");
  const Scene scene = load_scene("small");
  EXPECT_EQ(load_curve(scene).max_angle(), 120);
  write("scenes/small.yaml",
        "domain: {lower: [0, 0, 0], upper: [9, 9, 9]}\nwettability: {calibration: mine, rest_angle: 150}\n");
  EXPECT_TRUE(holds(refusal([] { load_scene("small"); }), "allowed: 60 to 120 degrees"));
}

TEST_F(OtherConfig, HoldsTheCalibrationOfMicroparticles) {
  write("calibration/glass.yaml", "description: d\ncommand: c\npoints: [[-20, 60, 1], [-10, 120, 1]]\n");
  const Scene scene = parse(
      "microparticle_model: {calibration: glass}\n"
      "microparticles: [{center: [-15, 0], radius: 1, contact_angle: 90}]\n");
  EXPECT_DOUBLE_EQ(scene.microparticles.at(0).attraction, -15);
  EXPECT_EQ(load_microparticle_curve(scene).max_angle(), 120);
}

TEST_F(OtherConfig, ACalibrationThatIsBrokenIsNamedInTheScene) {
  write("calibration/mine.yaml", "description: d\ncommand: c\npoints: [[-20, 60, 1], [-10, x, 1]]\n");
  const std::string text = refusal([] {
    parse_scene("domain: {lower: [0, 0, 0], upper: [9, 9, 9]}\nwettability: {calibration: mine}\n",
                "scene.yaml");
  });
  EXPECT_TRUE(holds(text, "scene.yaml:2: wettability.calibration: "));
  EXPECT_TRUE(holds(text, "mine.yaml:3: points[1][1]: x, allowed: a finite number"));
}

}  // namespace
}  // namespace dmf::chip
