#include "tools/studies/transport_table.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tools/trajectory.h"

namespace dmf::tools {
namespace {

using Records = std::vector<TransportRecord>;

constexpr double never = std::numeric_limits<double>::infinity();

// ---- what is varied ----

std::vector<VariedValue> nothing() {
  return {{"", [](chip::Scene&) {}}};
}

std::vector<VariedValue> radii(const std::vector<double>& values) {
  std::vector<VariedValue> result;
  for (const double radius : values)
    result.push_back({fmt::format("{}", radius), [radius](chip::Scene& scene) {
                        engine::DropletPlacement& droplet = scene.droplets.at(0);
                        droplet.radius = radius;
                        droplet.center.z() = scene.parameters.domain.lower.z() + radius;
                      }});
  return result;
}

std::vector<VariedValue> attractions(const std::vector<double>& values) {
  std::vector<VariedValue> result;
  for (const double attraction : values)
    result.push_back({fmt::format("{}", attraction), [attraction](chip::Scene& scene) {
                        scene.microparticles.at(0).attraction = attraction;
                      }});
  return result;
}

std::vector<VariedValue> frictions(const std::vector<std::pair<double, double>>& values) {
  std::vector<VariedValue> result;
  for (const auto& [sliding, rolling] : values)
    result.push_back(
        {fmt::format("{}/{}", sliding, rolling), [sliding = sliding, rolling = rolling](chip::Scene& scene) {
           scene.microparticles.at(0).static_friction = sliding;
           scene.microparticles.at(0).rolling_friction = rolling;
         }});
  return result;
}

std::vector<VariedValue> rest_angles(const std::vector<double>& values) {
  std::vector<VariedValue> result;
  for (const double angle : values)
    result.push_back(
        {fmt::format("{}", angle), [angle](chip::Scene& scene) { scene.electrowetting.rest_angle = angle; }});
  return result;
}

/// At the same friction between liquid beads: phi^2 = 2 gamma k_BT.
std::vector<VariedValue> temperatures(const std::vector<double>& values) {
  std::vector<VariedValue> result;
  for (const double temperature : values)
    result.push_back({fmt::format("{}", temperature), [temperature](chip::Scene& scene) {
                        const engine::LiquidParameters usual;
                        engine::LiquidParameters& liquid = scene.parameters.liquid;
                        liquid.temperature = temperature;
                        liquid.random_amplitude =
                            usual.random_amplitude * std::sqrt(temperature / usual.temperature);
                      }});
  return result;
}

// ---- what is measured ----

Quantity quantity(const char* name, const char* title, int decimals, double (Trajectory::*measure)() const,
                  std::vector<const char*> lan = {}) {
  return {name, title, decimals,
          [measure](const Records& records) {
            const Trajectory way(records, 1);
            // A droplet that has missed it says nothing of what it would have done with it.
            return std::isfinite(way.time_picked_up()) ? (way.*measure)() : NAN;
          },
          std::move(lan)};
}

/// On the wall it stands 1 less the indentation of some 0.0025: within a fifth of that.
Quantity mean_height(std::vector<const char*> lan = {}) {
  Quantity height =
      quantity("mean_height", "mean height over the wall (r_c)", 5, &Trajectory::mean_height, std::move(lan));
  height.margin = 0.0005;
  return height;
}

Quantity passes(const char* name, const char* title, double x, std::vector<const char*> lan = {}) {
  return {name, title, 0, [x](const Records& records) { return Trajectory(records, 1).time_at(x); },
          std::move(lan)};
}

Quantity picked_up() { return quantity("picked_up", "picked up at (tau)", 0, &Trajectory::time_picked_up); }
Quantity dropped_off_at(std::vector<const char*> lan = {}) {
  return quantity("dropped_off", "dropped off at (tau)", 0, &Trajectory::time_dropped_off, std::move(lan));
}
Quantity dropped_off_x(std::vector<const char*> lan = {}) {
  return quantity("dropped_off_x", "dropped off at x (r_c)", 2, &Trajectory::x_dropped_off, std::move(lan));
}
Quantity critical_velocity(std::vector<const char*> lan = {}) {
  Quantity velocity = quantity("critical_velocity", "critical velocity (r_c/tau)", 5,
                               &Trajectory::critical_velocity, std::move(lan));
  velocity.alike = true;
  return velocity;
}
Quantity velocity_before_drop_off(std::vector<const char*> lan = {}) {
  Quantity velocity = quantity("velocity_before", "mean velocity before the drop-off (r_c/tau)", 5,
                               &Trajectory::velocity_before_drop_off, std::move(lan));
  velocity.alike = true;
  return velocity;
}
Quantity drive_before_drop_off() {
  return quantity("drive_before", "mean drive before the drop-off (k_BT/r_c)", 1,
                  &Trajectory::drive_before_drop_off);
}
Quantity held_with() {
  return quantity("held_with", "drive until it let go (k_BT/r_c)", 1, &Trajectory::held_with);
}
Quantity contact_fraction() {
  return quantity("contact_fraction", "in contact with the wall", 3, &Trajectory::contact_fraction);
}

/// From the first r_c of its way to x = 0.
Quantity from_29_to_0() {
  return {"from_-29_to_0", "from x = -29 to 0 (tau)", 0, [](const Records& records) {
            const Trajectory way(records, 1);
            return way.time_at(0) - way.time_at(-29);
          }};
}

/// How many of the microparticles first, first + 2, ... of the multi_particle scene.
Quantity count(const char* name, const char* title, int first, bool (*counts)(const Trajectory&)) {
  return {name, title, 1, [first, counts](const Records& records) {
            double found = 0;
            for (int id = first; id <= 10; id += 2) found += counts(Trajectory(records, id));
            return found;
          }};
}
bool was_collected(const Trajectory& way) { return std::isfinite(way.time_picked_up()); }
bool is_carried(const Trajectory& way) { return way.carried_at_end(); }

}  // namespace

// ---- the studies ----

const std::vector<TransportStudy>& transport_table() {
  static const std::vector<TransportStudy> all{
      {"pickup",
       "the baseline: picked up and carried over the gradient",
       "",
       nothing(),
       8000,
       never,
       never,
       {picked_up(),
        passes("passes_0", "passes x = 0 at (tau)", 0, {"2317"}),
        from_29_to_0(),
        passes("passes_40", "passes x = 40 at (tau)", 40),
        // Of the droplet, for the 4800 stand beside its 2973 without a microparticle (Lan 3.2).
        {"droplet_passes_40",
         "the droplet passes x = 40 at (tau)",
         0,
         [](const Records& records) { return Trajectory(records, 1).droplet_time_at(40); },
         {"4800"}},
        quantity("fastest", "fastest at (tau)", 0, &Trajectory::time_fastest, {"2000 to 4000"}),
        mean_height({"0.9975"}),
        contact_fraction(),
        quantity("final_x", "rests at x (r_c)", 2, &Trajectory::final_x),
        dropped_off_at()}},
      {"pickup_size",
       "larger droplets: time of the microparticle from x = -30 to 0",
       "R",
       radii({5, 6, 7, 8}),
       10000,
       0,
       500,
       {picked_up(), passes("passes_0", "passes x = 0 at (tau)", 0, {"2317", "1673", "1324", "1140"}),
        from_29_to_0(), mean_height(), dropped_off_at()}},
      {"pickup_wetting",
       "attraction of the microparticle: dragged or swallowed",
       "A_ls",
       attractions({-15, -16, -17, -18, -19, -19.5}),
       8000,
       40,
       never,
       {picked_up(),
        mean_height({"0.99751", "0.99784", "0.99830"}),
        {"lifted",
         "lifted off the wall at (tau)",
         0,
         [](const Records& records) { return Trajectory(records, 1).time_lifted(); },
         {"never", "never", "never", "1153", "234", "150"}},
        quantity("final_height", "height at the end (r_c)", 2, &Trajectory::final_height,
                 {"1", "1", "1", "2", "2", "2"}),
        contact_fraction(),
        passes("passes_0", "passes x = 0 at (tau)", 0),
        passes("passes_40", "passes x = 40 at (tau)", 40)}},
      {"friction",
       "static and rolling friction of the microparticle on the wall",
       "f",
       frictions({{0.2, 0.2}, {0.4, 0.2}, {0.4, 0.4}, {0.8, 0.4}, {0.8, 0.8}, {1.6, 0.8}}),
       40000,
       40,
       500,
       {picked_up(), passes("passes_0", "passes x = 0 at (tau)", 0),
        passes("passes_40", "passes x = 40 at (tau)", 40, {"", "", "", "", "", "never"}),
        dropped_off_at({"never", "never", "never", "never", "never"}),
        dropped_off_x({"", "", "", "", "", "20"}),
        quantity("final_x", "rests at x (r_c)", 2, &Trajectory::final_x)}},
      {"dropoff_size",
       "strong friction: where droplets of each size lose it",
       "R",
       radii({5, 6, 7, 8}),
       40000,
       40,
       500,
       {picked_up(), dropped_off_at(), dropped_off_x({"20"}),
        critical_velocity({"0.00420", "0.00429", "0.00438", "0.00433"}),
        velocity_before_drop_off({"0.00420", "0.00429", "0.00438", "0.00433"}), drive_before_drop_off(),
        held_with(),
        passes("passes_40", "passes x = 40 at (tau)", 40, {"never", "never", "never", "never"})}},
      {"dropoff_wetting",
       "strong friction: what attraction keeps the microparticle",
       "A_ls",
       attractions({-15, -16, -17, -18}),
       40000,
       40,
       500,
       {picked_up(), dropped_off_at({"", "", "never", "never"}),
        dropped_off_x({"20", "20", "never", "never"}), critical_velocity({"0.00420"}),
        velocity_before_drop_off({"0.00420"}), drive_before_drop_off(), held_with(),
        passes("passes_40", "passes x = 40 at (tau)", 40, {"never", "never", "7 times that of -18"}),
        contact_fraction()}},
      {"holding_force",
       "the same force on droplets that hold a microparticle, over the plate's angle",
       "theta",
       rest_angles({60, 70, 80, 90, 100}),
       3000,
       never,
       20,
       {picked_up(), dropped_off_at()}},
      {"passive_delivery",
       "the plate alone decides where it is dropped",
       "",
       nothing(),
       8000,
       40,
       600,
       {picked_up(), dropped_off_at({"2520 to 3480"}), dropped_off_x({"-17.5 to -12.5"}), critical_velocity(),
        velocity_before_drop_off(), drive_before_drop_off(), held_with(),
        quantity("final_x", "microparticle rests at x (r_c)", 2, &Trajectory::final_x, {"-17.5 to -12.5"}),
        quantity("final_droplet_x", "droplet at the end (r_c)", 2, &Trajectory::final_droplet_x)}},
      {"active_delivery",
       "electrodes stop it, then pull the droplet away",
       "",
       nothing(),
       13000,
       never,
       never,
       {picked_up(),
        {"x_12000",
         "microparticle before the switch, x (r_c)",
         2,
         [](const Records& records) { return Trajectory(records, 1).x_at(11999); },
         {"-2.3 or 2.3"}},
        {"droplet_x_12000",
         "droplet before the switch, x (r_c)",
         2,
         [](const Records& records) { return Trajectory(records, 1).droplet_x_at(11999); },
         {"1"}},
        dropped_off_at({"12000 to 12800"}),
        // The region he designates: the text has it end at 1.5 and at -1.5, as it has it wait at 2.3 and
        // -2.3.
        {"x_13000",
         "microparticle at the end, x (r_c)",
         2,
         [](const Records& records) { return Trajectory(records, 1).x_at(13000); },
         {"-2 to 2"}},
        {"droplet_x_13000", "droplet at the end, x (r_c)", 2,
         [](const Records& records) { return Trajectory(records, 1).droplet_x_at(13000); }}}},
      {"thermal",
       "temperature: do fluctuations help the transport?",
       "k_BT",
       temperatures({0.25, 0.5, 1, 2}),
       8000,
       40,
       500,
       {picked_up(), passes("passes_0", "passes x = 0 at (tau)", 0), from_29_to_0(),
        passes("passes_40", "passes x = 40 at (tau)", 40), mean_height(), contact_fraction(),
        dropped_off_at()}},
      {"multi_particle",
       "ten microparticles of two wettabilities: which are collected?",
       "",
       nothing(),
       4000,
       never,
       never,
       {count("collected_hydrophobic", "hydrophobic ones picked up, of 5", 1, was_collected),
        count("collected_hydrophilic", "hydrophilic ones picked up, of 5", 2, was_collected),
        count("carried_hydrophobic", "hydrophobic ones carried at the end, of 5", 1, is_carried),
        count("carried_hydrophilic", "hydrophilic ones carried at the end, of 5", 2, is_carried),
        {"carried_touching_wall", "carried ones that drag along the wall at the end", 1,
         [](const Records& records) {
           double found = 0;
           for (int id = 1; id <= 10; ++id) {
             const Trajectory way(records, id);
             found += way.carried_at_end() && way.final_height() < 1.5;
           }
           return found;
         }}}}};
  return all;
}

}  // namespace dmf::tools
