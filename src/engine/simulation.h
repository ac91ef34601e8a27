#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/chain.h"
#include "engine/droplet.h"
#include "engine/membrane.h"
#include "engine/microparticle.h"
#include "engine/observe/snapshot.h"
#include "engine/parameters.h"
#include "engine/wettability.h"

namespace dmf::engine {

/// The run can't go on: a bead moved too far in one step or to no number, or the watchdog found a fault
/// (observe/watchdog.h). `what()` says which bead, droplet or microparticle, which step and which setting to
/// look at. The simulation refuses to step from then on.
class Instability : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How to run, as opposed to what: changes nothing in the results but the last bits between kernels.
struct Execution {
  int threads = 0;              ///< 0: as many as OpenMP offers
  std::string kernel = "auto";  ///< auto, or one of available_kernels()
};

/// Names of the kernels that this processor can run, best first; the last is "reference", double precision.
std::vector<std::string> available_kernels();

/// Beads, walls and their motion: the engine. Everything in reduced units. Not thread-safe: one thread owns
/// it.
class Simulation {
 public:
  /// @throws InvalidInput with every violated range, or when `execution.kernel` is unknown here.
  Simulation(const Parameters& parameters, ContactAngleCurve curve, const Execution& execution = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// One time step. @throws Instability.
  void step();

  /// Sets what contact angle the wall shows where, from the next step on.
  /// @throws InvalidInput, unchanged, when an angle is outside the curve's range or not finite, or the wall's
  /// attraction is given instead (fixed_wall_attraction()).
  void set_wettability(const ContactAngleField& field);

  /// Places a droplet at rest: beads on a lattice of the initial density, velocities drawn at k_BT, no net
  /// momentum.
  /// @throws InvalidInput, unchanged, when it is outside the domain, reaches another moving bead to within
  /// r_c, is too small to hold 20 beads, or would exceed max_beads.
  /// @returns the number of beads placed.
  std::size_t add_droplet(const DropletPlacement& placement);

  /// Fills a box with a liquid at rest, as far as nothing is there: sites of its lattice that are nearer to
  /// another bead than half a lattice constant, or to a microparticle than half an r_c, are left out.
  /// @throws InvalidInput, unchanged, when the box leaves the domain or holds no free site.
  std::size_t fill(const FillPlacement& placement);

  /// Fills the whole box with liquid of the initial density (bulk studies). @throws InvalidInput when not
  /// empty.
  std::size_t fill_box();
  /// Fills a slab lower <= position < upper with liquid (film studies). @throws InvalidInput as add_droplet.
  std::size_t fill_slab(const Vector3d& lower, const Vector3d& upper);

  /// Places chains of beads, in liquid or elsewhere. @returns the id of the first; the others count on.
  /// @throws InvalidInput, unchanged, when a number is out of range or the spring too stiff for time_step
  /// (violations() in chain.h), a chain finds no room in the box, a bead would be in a microparticle, or it
  /// would exceed max_beads.
  std::uint32_t add_chains(const ChainPlacement& placement);

  /// Places a membrane. @returns its id. @throws InvalidInput, unchanged, as add_chains, and with two
  /// dimensions.
  std::uint32_t add_membrane(const MembranePlacement& placement);

  /// Takes a droplet's beads out, and every chain and membrane that has a bead in it. @throws InvalidInput
  /// when no such droplet is tracked.
  void remove_droplet(std::uint32_t id);

  /// Places a microparticle at rest. @returns its id.
  /// @throws InvalidInput, unchanged, when a number is out of range (with the range, or the number that would
  /// work), its beads could not keep the liquid out, the contact would be too stiff for time_step, it leaves
  /// the plane of two dimensions, or it reaches through the wall, out of the domain, into liquid or into
  /// another microparticle.
  std::uint32_t add_microparticle(const MicroparticlePlacement& placement);

  /// Takes a microparticle out. @throws InvalidInput when there is none of that id.
  void remove_microparticle(std::uint32_t id);

  /// From the next step on. @throws InvalidInput, unchanged, when a component is not finite or so strong that
  /// one step from rest would lead farther than 0.001 r_c.
  void set_body_forces(const BodyForces& forces);
  const BodyForces& body_forces() const;

  /// The present state, immutable. Cheap without `beads` and `hash`: it copies what the tracker last saw.
  std::shared_ptr<const Snapshot> observe(const ObserveRequest& request = {}) const;

  /// Merges, splits, appearances since the last call, in order.
  std::vector<DropletEvent> take_events();

  /// Pickups and drop-offs since the last call, in order.
  std::vector<MicroparticleEvent> take_microparticle_events();

  /// The complete state as bytes: a simulation of the same parameters that loads it goes on with the same
  /// bits.
  std::string save_state() const;
  /// @throws InvalidInput, unchanged, when the bytes are not a state of a simulation with these parameters.
  void load_state(const std::string& bytes);

  std::uint64_t steps() const;
  double time() const;  ///< steps * time_step, tau
  const Parameters& parameters() const;
  const ContactAngleCurve& curve() const;
  const std::string& kernel() const;  ///< the one that runs
  int threads() const;

 private:
  std::size_t place(const std::vector<Vector3d>& sites, std::uint32_t species);
  std::vector<std::uint32_t> take(const std::vector<Vector3d>& sites,
                                  const std::vector<std::uint8_t>& species);
  void refresh();

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dmf::engine
