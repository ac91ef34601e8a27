#pragma once
#include <memory>

#include "chip/scene.h"
#include "node/convert.h"
#include "node/frame.h"

namespace dmf::node::testing {

/// The tests' own chip: four electrodes 6 r_c apart around x = -9, -3, 3, 9, one droplet of R = 3 on the
/// first.
inline chip::Scene tiny_scene() { return chip::load_scene(DMF_SOURCE_DIR "/test/scenes/tiny_line.yaml"); }

/// Units that make a mistaken conversion visible: no two of its factors are alike.
inline chip::Scene tiny_scene_in_round_units() {
  chip::Scene scene = tiny_scene();
  scene.units = {2e-5, 3e-13, 4e-6};  // m, kg, s
  return scene;
}

/// A frame as an engine might leave it: droplet 5 with two beads, droplet 7 with one, one stray bead,
/// microparticle 3 at the rear of droplet 5.
inline std::shared_ptr<Frame> example_frame(const chip::Scene& scene) {
  auto snapshot = std::make_shared<engine::Snapshot>();
  snapshot->step = 1200;
  snapshot->time = 12;
  snapshot->temperature = 1.01;
  snapshot->momentum = {1, 2, 3};
  snapshot->moving_beads = 4;
  snapshot->wall_beads = 99;
  snapshot->vapour_beads = 1;
  engine::DropletObservation droplet;
  droplet.id = 5;
  droplet.parents = {2, 3};
  droplet.beads = 2;
  droplet.centroid = {1, 2, 3};
  droplet.velocity = {0.5, -0.25, 0};
  droplet.lower = {0, 1, 2};
  droplet.upper = {2, 3, 4};
  droplet.volume = 10;
  droplet.footprint_area = 7;
  droplet.height = 4;
  droplet.footprint = {{0, 0}, {1, 0}, {0, 1}};
  droplet.advancing_angle = 100;
  snapshot->droplets.push_back(droplet);
  droplet = {};
  droplet.id = 7;
  droplet.beads = 1;
  snapshot->droplets.push_back(droplet);
  engine::MicroparticleObservation body;
  body.id = 3;
  body.radius = 1.5;
  body.magnetic = true;
  body.beads = 612;
  body.mass = 600;
  body.attraction = -15;
  body.position = {1, 2, 1.5};
  body.orientation = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitY());
  body.velocity = {0.5, 0, 0};
  body.angular_velocity = {0, 0.25, 0};
  body.contact_fraction = 0.75;
  body.normal_force = 20;
  body.drive_force = {4, 0, -20};
  body.friction_force = {-2, 0, 0};
  body.immersion = 0.9;
  body.droplet = 5;
  body.place = engine::MicroparticlePlace::rear;
  snapshot->microparticles.push_back(body);
  snapshot->positions = {{1, 2, 3}, {1.5, 2, 3}, {-4, 0, 1}, {8, 8, 8}};
  snapshot->velocities = {{3, 4, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}};
  snapshot->bead_ids = {10, 11, 12, 13};
  snapshot->bead_droplets = {5, 5, 7, 0};

  auto frame = std::make_shared<Frame>();
  frame->stamp = 2'500'000'000;
  frame->run = 3;
  frame->seed = 42;
  frame->kernel = "reference";
  frame->threads = 2;
  frame->snapshot = snapshot;
  frame->has_beads = true;
  for (const chip::Electrode& electrode : scene.layout.electrodes()) {
    const bool on = electrode.channel == 1;
    frame->electrodes.push_back({electrode.channel, on, on ? 63.0 : 0.0, on ? 50.0 : 120.0});
  }
  frame->rail = {63, 1000, true, ""};
  frame->body_forces = {{0, 0, -2}, {3, 0, 0}};
  frame->channels = {{0, 1}, {}};
  frame->steps_per_second = 321;
  return frame;
}

}  // namespace dmf::node::testing
