#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/bodies/body_beads.h"
#include "engine/bodies/contact.h"
#include "engine/bodies/rigid_body.h"
#include "engine/microparticle.h"
#include "engine/parameters.h"
#include "engine/walls/sheared_domain.h"
#include "engine/walls/solid.h"

namespace dmf::engine {

/// Means over the steps between two looks of the observer.
struct MicroparticleMeans {
  double contact_fraction = 0, normal_force = 0;
  Vector3d drive_force = Vector3d::Zero(), friction_force = Vector3d::Zero();
};

/// One microparticle.
struct Microparticle {
  std::uint32_t id = 0;
  MicroparticlePlacement placement;  ///< as it was asked for
  Friction friction{};
  RigidBody body;
  std::vector<Vector3d> offsets;  ///< of its beads, body frame
  std::vector<ContactSphere> contact_spheres;
  std::shared_ptr<const std::vector<Vector3d>> points;  ///< as MicroparticleObservation has them
  double bounding_radius = 0;                           ///< of all beads and contact spheres
  std::uint32_t first_bead = 0;                         ///< in BodyBeads
  std::vector<std::uint32_t> patch_ends;                ///< relative to first_bead

  // At the end of a step:
  Vector3d force = Vector3d::Zero();  ///< all but friction
  Vector3d torque = Vector3d::Zero();
  std::vector<WallContact> contacts;
  MicroparticleTotals totals;
  MicroparticleTotals last_look;  ///< totals when the observer looked
  MicroparticleMeans means;       ///< between the last two looks

  std::uint32_t bead_count() const { return static_cast<std::uint32_t>(offsets.size()); }
};

/// How far the beads of microparticles have moved.
struct BodyDriftReport {
  float largest_displacement_squared = 0;  ///< since the liquid was sorted, r_c^2
  std::uint32_t wild = 0;                  ///< id of one that moved too far in this step, or not to a number
};

/// All microparticles: rigid bodies that liquid and walls push and pull bead by bead, and that touch plates,
/// the solid of a label grid and each other (contact.h).
class Microparticles {
 public:
  explicit Microparticles(const Parameters& parameters);

  bool empty() const { return all_.empty(); }
  const std::vector<Microparticle>& all() const { return all_; }
  BodyBeads& beads() { return beads_; }
  const BodyBeads& beads() const { return beads_; }
  double largest_bounding_radius() const;

  /// Where images beyond sheared sides stand from now on.
  void set_images(const ShearedDomain& images) { images_ = images; }

  /// Appends one at rest.
  /// @param liquid         where liquid beads are.
  /// @param smallest_mass  that the magnet which is on allows; 0: it does not feel it.
  /// @throws InvalidInput, unchanged, as Simulation::add_microparticle.
  std::uint32_t add(const MicroparticlePlacement& placement, const std::vector<Vector3d>& liquid,
                    double smallest_mass = 0);
  /// @throws InvalidInput when a place for a liquid bead is in a microparticle or nearer to it than half an
  /// r_c.
  void require_clear(const std::vector<Vector3d>& sites) const;
  /// Whether a liquid bead may be placed there.
  bool clear_of(const Vector3d& site) const;
  /// @throws InvalidInput when there is none of that id.
  void remove(std::uint32_t id);

  /// Kick, friction, move: the bodies' share of integrate.h's drift().
  BodyDriftReport drift();
  /// Sums the forces on the beads, adds contact and far forces, and kicks: their share of finish().
  void finish(const BodyForces& far);

  /// The liquid has been sorted: wraps centres into periodic sides and notes where beads are now.
  void note_listed();
  /// The observer looks: means() are of the steps since its last look.
  void note_look();

  void archive(Archive& archive);

 private:
  void require_room(const Microparticle& particle) const;
  bool is_in_solid(const Microparticle& particle) const;
  void append_beads(const Microparticle& particle);
  void place_beads(const Microparticle& particle, const Vector3d& centre_velocity);
  void touch_walls(Microparticle& particle);
  void touch_sides(Microparticle& particle, const ContactSphere& sphere, const Vector3d& arm);
  void touch_solid(Microparticle& particle, const ContactSphere& sphere, const Vector3d& arm);
  /// @param arm  from the centre of mass to the sphere's. @returns the contact, whose forces act now.
  WallContact press(Microparticle& particle, const ContactSphere& sphere, const Vector3d& arm,
                    const Vector3d& normal, double distance) const;
  struct SphereTouch {
    Vector3d force = Vector3d::Zero(), arm = Vector3d::Zero();  ///< from the centre of mass to where it acts
  };
  /// Adds what a sphere of another microparticle, or of an image, does to one of this one's; nothing out of
  /// reach. @param to_other  from the centre of mass to the other sphere's centre.
  SphereTouch push(Microparticle& particle, const ContactSphere& own, const ContactSphere& other,
                   const Vector3d& to_other) const;
  double force_between(const ContactSphere& first, const ContactSphere& second, double distance) const;
  void touch_each_other();
  void touch_mirror_images();

  Parameters parameters_;
  ShearedDomain images_;
  Solid solid_;
  std::vector<SolidTouch> touches_;  ///< reused
  std::uint32_t next_id_ = 1;
  std::vector<Microparticle> all_;
  BodyBeads beads_;
};

}  // namespace dmf::engine
