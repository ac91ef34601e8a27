#include "engine/parameters.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/memory.h"
#include "engine/walls/violations.h"

namespace dmf::engine {
namespace {

/// Collects what is out of range.
class RangeCheck {
 public:
  explicit RangeCheck(std::vector<std::string>& found) : found_(found) {}
  void within(const char* key, double value, double lower, double upper, const char* allowed) {
    if (!(value >= lower && value <= upper))
      found_.push_back(fmt::format("{}: {}, allowed: {}", key, value, allowed));
  }
  void holds(bool condition, const std::string& text) {
    if (!condition) found_.push_back(text);
  }

 private:
  std::vector<std::string>& found_;
};

constexpr double tiny = 1e-9;

void check_liquid(const LiquidParameters& liquid, RangeCheck& check) {
  if (liquid.repulsion == 0) {
    check.within("liquid.attraction", liquid.attraction, 0, 200, "0 to 200 with repulsion 0 (plain DPD)");
  } else {
    check.within("liquid.attraction", liquid.attraction, -200, -tiny,
                 "-200 up to below 0 (attraction is negative), or with repulsion 0 0 to 200 (plain DPD)");
    check.within("liquid.repulsion", liquid.repulsion, tiny, 500, "above 0 up to 500, or 0 (plain DPD)");
  }
  check.within("liquid.cutoff_radius", liquid.cutoff_radius, 1, 1, "1 (it is the unit of length)");
  check.within("liquid.repulsion_radius", liquid.repulsion_radius, 0.3, 1, "0.3 to 1 (r_c)");
  check.within("liquid.random_amplitude", liquid.random_amplitude, 0, 50, "0 to 50");
  const double twice = 2 * liquid.dissipation_exponent;
  check.within("liquid.dissipation_exponent", liquid.dissipation_exponent, 0.5,
               std::nearbyint(twice) == twice ? 4 : 0, "0.5, 1, 1.5 and so on up to 4");
  check.within("liquid.dissipation_radius", liquid.dissipation_radius, 0.5, 2.5, "0.5 to 2.5 (r_c)");
  check.within("liquid.temperature", liquid.temperature, tiny, 10, "above 0 up to 10 (k_BT)");
  check.within("liquid.initial_density", liquid.initial_density, 1, 12, "1 to 12 (beads per r_c^3)");
  check.within("liquid.bulk_density", liquid.bulk_density, 1, 20, "1 to 20 (beads per r_c^3)");
  check.within("liquid.viscosity", liquid.viscosity, tiny, 1000, "above 0 up to 1000 (m / (r_c tau))");
  check.within("liquid.wall_distance", liquid.wall_distance, 0, 1, "0 to 1 (r_c)");
  check.within("liquid.surface_tension", liquid.surface_tension, tiny, 1000,
               "above 0 up to 1000 (k_BT / r_c^2)");
}

void check_microparticles(const MicroparticleParameters& model, RangeCheck& check) {
  check.within("microparticle_model.elastic_modulus", model.elastic_modulus, tiny, 1e12,
               "above 0 up to 1e12 (k_BT / r_c^3)");
  check.within("microparticle_model.contact_damping", model.contact_damping, 0, 2,
               "0 to 2 (of the critical damping)");
  check.within("microparticle_model.wall_attraction", model.wall_attraction, -200, 0,
               "-200 to 0 (attraction is negative)");
  check.within("microparticle_model.liquid_repulsion", model.liquid_repulsion, tiny, 500,
               "above 0 up to 500");
  check.within("microparticle_model.particle_adhesion", model.particle_adhesion, 0, 1e6,
               "0 to 1e6 (k_BT / r_c)");
}

void check_watchdog(const WatchdogParameters& watchdog, RangeCheck& check) {
  check.within("watchdog.temperature[0]", watchdog.lowest_temperature, 0, 1 - tiny, "0 up to below 1");
  check.within("watchdog.temperature[1]", watchdog.highest_temperature, 1 + tiny, 100, "above 1 up to 100");
  check.within("watchdog.evaporation", watchdog.evaporation, tiny, 1,
               "above 0 up to 1 (of a droplet's beads)");
  check.within("watchdog.leak", watchdog.leak, 0, 1e6, "0 to 1000000 (beads)");
}

void check_domain(const Domain& domain, double list_range, RangeCheck& check) {
  static const char* const axes = "xyz";
  for (int axis = 0; axis < 3; ++axis) {
    const double size = domain.size()[axis];
    const bool periodic = domain.lower_side[axis] == Side::periodic;
    check.holds(std::isfinite(size) && size >= 3 && size <= 4000,
                fmt::format("domain.{}: {} long, allowed: 3 to 4000 (r_c)", axes[axis], size));
    check.holds(
        periodic == (domain.upper_side[axis] == Side::periodic),
        fmt::format("domain.sides.{}: periodic on one side only, allowed: periodic on both or on none",
                    axes[axis]));
    check.holds(
        !periodic || size >= 3 * list_range,
        fmt::format(
            "domain.{}: {} long, allowed: at least {} (three times cutoff_radius + list_skin) when periodic",
            axes[axis], size, 3 * list_range));
    const bool lower_wets = domain.lower_side[axis] == Side::wall;
    const bool upper_wets = domain.upper_side[axis] == Side::wall;
    check.holds(axis == 2 ? lower_wets || !upper_wets : !lower_wets && !upper_wets,
                fmt::format("domain.sides.{}: wall, allowed: a wall of beads on the lower z side, and a top "
                            "plate over it",
                            axes[axis]));
  }
}

/// What is there before the first bead: refused here, before any of it is allocated.
void check_memory(const Parameters& parameters, RangeCheck& check) {
  const MemoryNeed need = memory_need(parameters, 0, 0);
  if (need.total() <= parameters.max_memory * bytes_per_megabyte) return;
  const Vector3d size = parameters.domain.size(), fits = largest_domain(parameters);
  check.holds(false, fmt::format("domain: {:g} x {:g} x {:g} r_c with {:.0f} wall beads takes {:.0f} MB, "
                                 "allowed: {:.0f} MB (max_memory), such as {:.0f} x {:.0f} x {:.0f} r_c",
                                 size.x(), size.y(), size.z(), wall_beads(parameters),
                                 need.total() / bytes_per_megabyte, parameters.max_memory, fits.x(), fits.y(),
                                 fits.z()));
}

}  // namespace

std::vector<std::string> violations(const Parameters& parameters) {
  std::vector<std::string> found;
  RangeCheck check(found);
  check_liquid(parameters.liquid, check);
  check.within("wall.lattice_constant", parameters.wall.lattice_constant, 0.5, 1.5, "0.5 to 1.5 (r_c)");
  check.within("wall.layers", parameters.wall.layers, 1, 8, "1 to 8");
  check.within("wall.top_contact_angle", parameters.wall.top_contact_angle, tiny, 180,
               "above 0 up to 180 (degrees), within the calibration");
  if (parameters.wall.attraction)
    check.within("wall.attraction", *parameters.wall.attraction, -200, 200, "-200 to 200");
  check_microparticles(parameters.microparticles, check);
  check_domain(parameters.domain, parameters.liquid.range() + parameters.list_skin, check);
  check.within("time_step", parameters.time_step, tiny, 0.1, "above 0 up to 0.1 (tau)");
  check.within("integrator_lambda", parameters.integrator_lambda, 0.5, 1, "0.5 to 1");
  check.within("list_skin", parameters.list_skin, 0.05, 1, "0.05 to 1 (r_c)");
  check.within("observe_interval", parameters.observe_interval, 1, 100000, "1 to 100000 (steps)");
  check.within("angle_window", parameters.angle_window, 0, 1e4, "0 to 10000 (tau)");
  check.within("max_beads", static_cast<double>(parameters.max_beads), 1, 100e6, "1 to 100000000");
  check.within("max_memory", parameters.max_memory, 10, 1e6, "10 to 1000000 (MB)");
  check_watchdog(parameters.watchdog, check);
  for (const auto& violations :
       {mixture_violations(parameters), spline_violations(parameters), boundary_violations(parameters)})
    found.insert(found.end(), violations.begin(), violations.end());
  // A domain that is out of range is told already.
  if (found.empty()) found = label_grid_violations(parameters);
  if (found.empty()) check_memory(parameters, check);
  return found;
}

}  // namespace dmf::engine
