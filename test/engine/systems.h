#pragma once
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/forces.h"
#include "engine/noise.h"
#include "engine/pairs.h"
#include "engine/parameters.h"
#include "engine/walls/walls.h"

namespace dmf::engine {

/// A system whose forces can be computed alone, for kernel and list tests. Positions scatter like a hot
/// liquid's.
struct System {
  std::string name;
  Parameters parameters;
  Beads beads;
  ContactAngleCurve curve = ContactAngleCurve::lan2016();
  std::vector<MicroparticlePlacement> microparticles{};
};

inline Parameters periodic_box(double size) {
  Parameters parameters;
  parameters.domain.lower = Vector3d::Zero();
  parameters.domain.upper = Vector3d::Constant(size);
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::periodic};
  return parameters;
}

inline Parameters plate(double size, double height) {
  Parameters parameters;
  parameters.domain.lower = {0, 0, 0};
  parameters.domain.upper = {size, size, height};
  parameters.domain.lower_side = {Side::periodic, Side::periodic, Side::wall};
  parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::reflecting};
  return parameters;
}

inline Parameters two_plates(double size, double gap) {
  Parameters parameters = plate(size, gap);
  parameters.domain.upper_side[2] = Side::wall;
  return parameters;
}

/// Uniform numbers in [0, 1) that depend on their index only.
inline double scatter(std::uint32_t index) { return mix32(index * 2654435761u + 12345u) / 4294967296.0; }

inline void add_bead(System& system, const Vector3d& at) {
  const std::uint32_t id = static_cast<std::uint32_t>(system.beads.size());
  const auto normal = [id](int k) { return static_cast<float>(2 * scatter(9 * id + k) - 1) * 1.7f; };
  const Record position{static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()),
                        0};
  system.beads.add(position, {normal(0), normal(1), normal(2), 0}, id);
  const std::uint32_t key = bead_key(step_key(system.parameters.seed, 3, Stream::pair), id);
  std::memcpy(&system.beads.position.back().w, &key, sizeof key);
}

/// `density` beads per r_c^3, scattered where `inside` holds.
template <class Inside>
void scatter_beads(System& system, double density, const Vector3d& lower, const Vector3d& upper,
                   Inside inside) {
  const std::uint32_t count = static_cast<std::uint32_t>(density * (upper - lower).prod());
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vector3d fraction(scatter(3 * k), scatter(3 * k + 1), scatter(3 * k + 2));
    const Vector3d at = lower + fraction.cwiseProduct(upper - lower);
    if (inside(at)) add_bead(system, at);
  }
}

/// Writes into the keys what the force pass of a mixture, and that of a spline, read there.
inline void note_species(System& system) {
  Beads& beads = system.beads;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    std::uint32_t key;
    std::memcpy(&key, &beads.position[k].w, sizeof key);
    key = key / 8 * 8 + beads.species_of(k);
    std::memcpy(&beads.position[k].w, &key, sizeof key);
  }
}

/// Three liquids in place of one, every pair and the walls with a law of their own, and one of them with
/// microparticles. Bead k becomes one of liquid k mod 3.
inline void mix(System& system) {
  MixtureParameters& mixture = system.parameters.mixture;
  const bool plain = system.parameters.liquid.repulsion == 0;
  const auto law = [plain](double attraction, double repulsion, double random_amplitude) {
    return plain ? PairCoefficients{-attraction, 0, random_amplitude}
                 : PairCoefficients{attraction, repulsion, random_amplitude};
  };
  mixture.liquids = {{"oil", law(-33, 20, 5)}, {"wax", law(-28, 31, 2)}};
  mixture.pairs = {{"liquid", "oil", law(-21, 25, 7)}, {"wax", "liquid", law(-17, 12, 0)},
                   {"oil", "wax", law(-9, 40, 9)},     {"oil", "wall", law(-19, 22, 4)},
                   {"wall", "wax", law(-13, 27, 8)},   {"microparticle", "oil", law(-23, 7, 11)}};
  Beads& beads = system.beads;
  beads.species.clear();
  for (std::size_t k = 0; k < beads.size(); ++k) beads.species.push_back(static_cast<std::uint8_t>(k % 3));
  note_species(system);
}

/// Liu's potential of short-range repulsion and longer-range attraction, of plain DPD's strength.
inline SplineParameters liu_spline() {
  SplineParameters spline;
  spline.used = true;
  return spline;
}

/// Lan's microparticle, on the wall when it has no z.
inline MicroparticlePlacement sphere_at(const Eigen::Vector2d& center, std::optional<double> z = {}) {
  MicroparticlePlacement placement;
  placement.center = center;
  placement.z = z;
  return placement;
}

inline std::vector<System> all_systems() {
  std::vector<System> systems;
  const auto begin = [&](const char* name, const Parameters& parameters) -> System& {
    systems.push_back({name, parameters, {}});
    return systems.back();
  };
  const auto everywhere = [](const Vector3d&) { return true; };
  {
    System& s = begin("bulk", periodic_box(8));
    scatter_beads(s, 6, s.parameters.domain.lower, s.parameters.domain.upper, everywhere);
  }
  {
    System& s = begin("smallest periodic box", periodic_box(3.75));
    scatter_beads(s, 6, s.parameters.domain.lower, s.parameters.domain.upper, everywhere);
  }
  {
    System& s = begin("free droplet", periodic_box(12));
    scatter_beads(s, 6, {2, 2, 2}, {10, 10, 10},
                  [](const Vector3d& p) { return (p - Vector3d(6, 6, 6)).norm() < 4; });
  }
  {
    System& s = begin("droplet over a periodic corner", periodic_box(12));
    scatter_beads(s, 6, {0, 0, 0}, {12, 12, 12}, [](const Vector3d& p) {
      Vector3d d = p;
      for (int axis = 0; axis < 3; ++axis) d[axis] -= 12 * std::nearbyint(d[axis] / 12);
      return d.norm() < 3;
    });
  }
  {
    System& s = begin("droplet on wall", plate(14, 12));
    scatter_beads(s, 6, {2, 2, 0}, {12, 12, 8},
                  [](const Vector3d& p) { return (p - Vector3d(7, 7, 2)).norm() < 4; });
  }
  {
    System& s = begin("droplet on wall over a periodic edge", plate(14, 12));
    scatter_beads(s, 6, {-4, 2, 0}, {4, 12, 8},
                  [](const Vector3d& p) { return (p - Vector3d(0, 7, 2)).norm() < 4; });
  }
  {
    System& s = begin("thin film", plate(9, 10));
    scatter_beads(s, 6, {0, 0, 0}, {9, 9, 1.2}, everywhere);
  }
  {
    System& s = begin("sparse vapour", periodic_box(10));
    scatter_beads(s, 0.3, s.parameters.domain.lower, s.parameters.domain.upper, everywhere);
  }
  {
    System& s = begin("single pair", periodic_box(10));
    add_bead(s, {5, 5, 5});
    add_bead(s, {5.3, 5.4, 5});
  }
  {
    System& s = begin("pair across a periodic edge", periodic_box(10));
    add_bead(s, {0.2, 5, 9.9});
    add_bead(s, {9.9, 5.2, 0.1});
  }
  {
    System& s = begin("one bead on the wall plane", plate(9, 10));
    add_bead(s, {4, 4, 0});
  }
  {
    System& s =
        begin("pancake over a periodic edge, between plates that one bead feels both of", two_plates(14, 3));
    s.parameters.domain.upper.z() = 1.8;
    scatter_beads(s, 6, {-4, 3, 0}, {4, 11, 1.8},
                  [](const Vector3d& p) { return (p - Vector3d(0, 7, p.z())).norm() < 4; });
  }
  {
    System& s = begin("microparticle that touches the top plate in a pancake", two_plates(14, 3));
    s.microparticles = {sphere_at({6, 7}, 2.0)};
    scatter_beads(s, 6, {2, 2, 0}, {12, 12, 3}, [](const Vector3d& p) {
      return (p - Vector3d(7, 7, p.z())).norm() < 4 && (p - Vector3d(6, 7, 2)).norm() > 1.3;
    });
  }
  {
    System& s = begin("droplet around a microparticle on the wall", plate(14, 12));
    s.microparticles = {sphere_at({6, 7})};
    scatter_beads(s, 6, {2, 2, 0}, {12, 12, 8}, [](const Vector3d& p) {
      return (p - Vector3d(7, 7, 2)).norm() < 4 && (p - Vector3d(6, 7, 1)).norm() > 1.3;
    });
  }
  {
    System& s = begin("two microparticles in liquid over a periodic corner", periodic_box(9));
    s.microparticles = {sphere_at({0.2, 8.8}, 0.1), sphere_at({3.5, 0.3}, 8.5)};
    scatter_beads(s, 6, s.parameters.domain.lower, s.parameters.domain.upper, [&s](const Vector3d& p) {
      for (const MicroparticlePlacement& one : s.microparticles) {
        const Vector3d centre(one.center.x(), one.center.y(), *one.z);
        if (s.parameters.domain.nearest_image(p - centre).norm() < 1.2) return false;
      }
      return true;
    });
  }
  {
    System& s = begin("plain DPD with a friction that reaches farther", periodic_box(7));
    s.parameters.liquid.attraction = 25;
    s.parameters.liquid.repulsion = 0;
    s.parameters.liquid.dissipation_exponent = 0.5;
    s.parameters.liquid.dissipation_radius = 1.4;
    scatter_beads(s, 4, s.parameters.domain.lower, s.parameters.domain.upper, everywhere);
  }
  {
    System& s = begin("linear weight of friction around a microparticle on the wall", plate(14, 12));
    s.parameters.liquid.dissipation_exponent = 1;
    s.microparticles = {sphere_at({6, 7})};
    scatter_beads(s, 6, {2, 2, 0}, {12, 12, 8}, [](const Vector3d& p) {
      return (p - Vector3d(7, 7, 2)).norm() < 3 && (p - Vector3d(6, 7, 1)).norm() > 1.3;
    });
  }
  {
    System& s = begin("steep weight of a friction of short range on a wall", plate(9, 10));
    s.parameters.liquid.dissipation_exponent = 3.5;
    s.parameters.liquid.dissipation_radius = 0.8;
    scatter_beads(s, 6, {0, 0, 0}, {9, 9, 1.2}, everywhere);
  }
  {
    System& s = begin("mixture in a box", periodic_box(5));
    scatter_beads(s, 6, s.parameters.domain.lower, s.parameters.domain.upper, everywhere);
    mix(s);
  }
  {
    System& s = begin("mixture around a microparticle on the wall", plate(14, 12));
    s.microparticles = {sphere_at({6, 7})};
    scatter_beads(s, 6, {2, 2, 0}, {12, 12, 8}, [](const Vector3d& p) {
      return (p - Vector3d(7, 7, 2)).norm() < 3 && (p - Vector3d(6, 7, 1)).norm() > 1.3;
    });
    mix(s);
  }
  {
    System& s = begin("mixture of plain DPD with a linear weight between plates", two_plates(6, 3));
    s.parameters.liquid.attraction = 25;
    s.parameters.liquid.repulsion = 0;
    s.parameters.liquid.dissipation_exponent = 1;
    scatter_beads(s, 4, {0, 0, 0}, {6, 6, 3}, everywhere);
    mix(s);
  }
  {
    System& s = begin("spline force of one liquid on a wall", plate(9, 10));
    s.parameters.liquid.attraction = 18.75;
    s.parameters.liquid.repulsion = 0;
    s.parameters.spline = liu_spline();
    scatter_beads(s, 6, {0, 0, 0}, {9, 9, 1.2}, everywhere);
    note_species(s);
  }
  {
    System& s = begin("spline forces of a mixture", periodic_box(5));
    s.parameters.liquid.attraction = 18.75;
    s.parameters.liquid.repulsion = 0;
    s.parameters.spline = liu_spline();
    scatter_beads(s, 4, s.parameters.domain.lower, s.parameters.domain.upper, everywhere);
    mix(s);
  }
  {
    System& s = begin("plain DPD between walls that move", two_plates(5, 4));
    s.parameters.liquid.attraction = 18.75;
    s.parameters.liquid.repulsion = 0;
    s.parameters.boundaries.lower_velocity = {1, -0.5};
    s.parameters.boundaries.upper_velocity = {-2, 0};
    scatter_beads(s, 4, {0, 0, 0}, {5, 5, 4}, everywhere);
  }
  {
    System& s = begin("two-dimensional droplet on a wall", plate(14, 12));
    s.parameters.dimensions = 2;
    s.parameters.domain.lower_side[1] = s.parameters.domain.upper_side[1] = Side::reflecting;
    scatter_beads(s, 0.5, {2, 2, 0}, {12, 12, 8},
                  [](const Vector3d& p) { return (p - Vector3d(7, p.y(), 2)).norm() < 4; });
    for (Record& at : s.beads.position) at.y = 7;
    for (Record& velocity : s.beads.velocity) velocity.y = 0;
    s.beads.predicted = s.beads.velocity;
  }
  add_bead(begin("one bead", periodic_box(10)), {1, 2, 3});
  begin("no bead", periodic_box(10));
  return systems;
}

/// Kernels load whole registers, past the last bead too: what they find there must not matter.
inline void poison_behind(Beads& beads, BodyBeads& body_beads) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (AlignedVector<Record>* array :
       {&beads.position, &beads.predicted, &body_beads.position, &body_beads.moving}) {
    const std::size_t count = array->size();
    array->resize(count + 16, {nan, nan, nan, nan});
    array->resize(count);
  }
}

/// A wall with a gradient, so that every wall bead is its own.
inline Walls wall_of(const System& system) {
  Parameters parameters = system.parameters;
  parameters.wall.top_contact_angle = 75;
  Walls wall(parameters);
  const double width = system.parameters.domain.size().x();
  wall.set_wettability([width](double x, double) { return 150 - 110 * std::clamp(x / width, 0.0, 1.0); },
                       system.curve);
  wall.set_fixed_wettability(parameters, system.curve);
  return wall;
}

/// The microparticles of a system, every bead of them with a velocity of its own.
inline Microparticles microparticles_of(const System& system) {
  Microparticles bodies(system.parameters);
  for (const MicroparticlePlacement& placement : system.microparticles) bodies.add(placement, {});
  bodies.note_listed();
  std::uint32_t k = 0;
  for (Record& moving : bodies.beads().moving)
    for (float* component : {&moving.x, &moving.y, &moving.z})
      *component = static_cast<float>(2 * scatter(7777 + k++) - 1);
  return bodies;
}

/// A system whose beads have been sorted and whose neighbours are known: ready for its forces.
struct Sorted {
  Sorted(System& system, const std::string& kernel)
      : wall(wall_of(system)),
        bodies(microparticles_of(system)),
        pairs(system.parameters),
        forces(system.parameters, kernel) {
    pairs.rebuild(system.beads, wall);
    pairs.find_bodies(bodies, system.beads, wall);
    poison_behind(system.beads, bodies.beads());
  }

  Walls wall;
  Microparticles bodies;
  Pairs pairs;
  Forces forces;
};

}  // namespace dmf::engine
