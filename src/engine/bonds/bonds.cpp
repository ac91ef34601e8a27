#include "engine/bonds/bonds.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/noise.h"

namespace dmf::engine {
namespace {

Vector3d at(const Record& record) { return {record.x, record.y, record.z}; }

void add(Record& to, const Vector3d& force) {
  to.x += static_cast<float>(force.x());
  to.y += static_cast<float>(force.y());
  to.z += static_cast<float>(force.z());
}

constexpr const char* look_at = "look at time_step, the spring and the forces on it";

std::uint64_t fold(std::uint64_t hash, double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return mix64(hash ^ bits) + 1;
}

std::uint64_t fold(std::uint64_t hash, const SpringLaw& law) {
  hash = mix64(hash ^ static_cast<std::uint64_t>(law.kind)) + 1;
  return fold(fold(fold(hash, law.stiffness), law.length), law.repulsion);
}

std::uint64_t fold(std::uint64_t hash, const std::vector<std::uint32_t>& ids) {
  for (const std::uint32_t id : ids) hash = mix64(hash ^ id) + 1;
  return hash;
}

}  // namespace

double longest_bond(const Domain& domain) {
  double longest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    if (domain.periodic(axis)) longest = std::min(longest, domain.size()[axis] / 3);
  return longest;
}

Bonds::Bonds(const Parameters& parameters)
    : parameters_(parameters), images_{parameters.domain}, longest_(longest_bond(parameters.domain)) {}

std::size_t Bonds::bead_count() const {
  std::size_t count = 0;
  for (const Chain& chain : chains_) count += chain.beads.size();
  for (const Membrane& membrane : membranes_) count += membrane.beads.size();
  return count;
}

std::uint32_t Bonds::bind_chain(const Spring& spring, const Vector3d& stretching_force,
                                std::vector<std::uint32_t> bead_ids) {
  chains_.push_back({next_chain_,
                     spring,
                     stretching_force,
                     SpringLaw::of(spring, parameters_.liquid.temperature),
                     std::move(bead_ids),
                     {}});
  return next_chain_++;
}

std::uint32_t Bonds::bind_membrane(const MembranePlacement& placement, std::vector<std::uint32_t> bead_ids) {
  membranes_.push_back({next_membrane_,
                        placement,
                        MembraneNetwork(*placement.mesh, placement.stiffness),
                        std::move(bead_ids),
                        {}});
  return next_membrane_++;
}

void Bonds::remove_with(std::vector<bool>& gone) {
  const auto goes = [&gone](const auto& bound) {
    const auto taken = [&gone](std::uint32_t id) { return id < gone.size() && gone[id]; };
    if (std::none_of(bound.beads.begin(), bound.beads.end(), taken)) return false;
    for (const std::uint32_t id : bound.beads) gone[id] = true;
    return true;
  };
  chains_.erase(std::remove_if(chains_.begin(), chains_.end(), goes), chains_.end());
  membranes_.erase(std::remove_if(membranes_.begin(), membranes_.end(), goes), membranes_.end());
}

void Bonds::find(const Beads& beads) {
  const auto count = static_cast<std::ptrdiff_t>(beads.size());
  const std::uint32_t above = beads.id.empty() ? 0 : *std::max_element(beads.id.begin(), beads.id.end()) + 1;
  index_of_id_.resize(above);
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) index_of_id_[beads.id[i]] = static_cast<std::uint32_t>(i);
  const auto look_up = [this](auto& bound) {
    bound.indices.resize(bound.beads.size());
    for (std::size_t k = 0; k < bound.beads.size(); ++k) bound.indices[k] = index_of_id_[bound.beads[k]];
  };
  for (Chain& chain : chains_) look_up(chain);
  for (Membrane& membrane : membranes_) look_up(membrane);
}

std::string Bonds::add_forces(Beads& beads) const {
  std::ptrdiff_t broken_chain = -1, broken_membrane = -1;
  const auto chains = static_cast<std::ptrdiff_t>(chains_.size());
  const auto membranes = static_cast<std::ptrdiff_t>(membranes_.size());
#pragma omp parallel for schedule(dynamic, 1) reduction(max : broken_membrane) if (membranes > 1)
  for (std::ptrdiff_t k = 0; k < membranes; ++k)
    if (!add_forces(membranes_[k], beads)) broken_membrane = std::max(broken_membrane, k);
#pragma omp parallel for schedule(dynamic, 16) reduction(max : broken_chain) if (chains > 16)
  for (std::ptrdiff_t k = 0; k < chains; ++k)
    if (!add_forces(chains_[k], beads)) broken_chain = std::max(broken_chain, k);
  if (broken_chain >= 0) return overstretched(chains_[broken_chain], beads);
  if (broken_membrane >= 0) return overstretched(membranes_[broken_membrane], beads);
  return "";
}

bool Bonds::add_forces(const Chain& chain, Beads& beads) const {
  const double longest = std::min(chain.law.max_length(), longest_);
  bool sound = true;
  for (std::size_t k = 0; k + 1 < chain.indices.size(); ++k) {
    const std::uint32_t i = chain.indices[k], j = chain.indices[k + 1];
    const Vector3d apart = images_.nearest_image(at(beads.position[j]) - at(beads.position[i]));
    const double r = apart.norm();
    sound = sound && r < longest;
    // Two beads in one place pull each other nowhere.
    const Vector3d pull = r > 0 ? Vector3d(chain.law.tension(r) / r * apart) : Vector3d::Zero();
    add(beads.force[i], pull);
    add(beads.force[j], -pull);
  }
  if (!chain.stretching_force.isZero(0)) {
    add(beads.force[chain.indices.front()], -chain.stretching_force);
    add(beads.force[chain.indices.back()], chain.stretching_force);
  }
  return sound;
}

bool Bonds::add_forces(const Membrane& membrane, Beads& beads) const {
  const std::vector<Vector3d> positions = positions_of(membrane, beads);
  std::vector<Vector3d> forces(positions.size(), Vector3d::Zero());
  if (!membrane.network.add_forces(positions, forces)) return false;
  for (std::size_t k = 0; k < forces.size(); ++k) add(beads.force[membrane.indices[k]], forces[k]);
  return true;
}

void Bonds::for_each_stress(
    const Beads& beads,
    const std::function<void(std::uint32_t, const Vector3d&, const Eigen::Matrix3d&)>& visit) const {
  for (const Chain& chain : chains_) {
    const std::vector<Vector3d> positions = positions_of(chain, beads);
    for (std::size_t k = 0; k + 1 < positions.size(); ++k) {
      const Vector3d apart = positions[k] - positions[k + 1];
      const double r = apart.norm();
      if (r == 0) continue;
      const Eigen::Matrix3d half = -0.5 * chain.law.tension(r) / r * apart * apart.transpose();
      visit(chain.indices[k], apart, half);
      visit(chain.indices[k + 1], -apart, half);
    }
  }
  for (const Membrane& membrane : membranes_) {
    const std::vector<Vector3d> positions = positions_of(membrane, beads);
    std::vector<Vector3d> forces(positions.size(), Vector3d::Zero());
    if (!membrane.network.add_forces(positions, forces)) continue;
    Vector3d centroid = Vector3d::Zero();
    for (const Vector3d& p : positions) centroid += p / static_cast<double>(positions.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const Eigen::Matrix3d stress = (positions[k] - centroid) * forces[k].transpose();
      visit(membrane.indices[k], Vector3d::Zero(), 0.5 * (stress + stress.transpose()));
    }
  }
}

std::vector<Vector3d> Bonds::positions_of(const Chain& chain, const Beads& beads) const {
  std::vector<Vector3d> positions;
  positions.reserve(chain.indices.size());
  for (const std::uint32_t index : chain.indices) {
    const Vector3d here = at(beads.position[index]);
    positions.push_back(
        positions.empty() ? here : positions.back() + images_.nearest_image(here - positions.back()));
  }
  return positions;
}

std::vector<Vector3d> Bonds::positions_of(const Membrane& membrane, const Beads& beads) const {
  std::vector<Vector3d> positions(membrane.indices.size());
  const std::vector<std::uint32_t>& order = membrane.network.order();
  positions[order.front()] = at(beads.position[membrane.indices[order.front()]]);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Vector3d& before = positions[membrane.network.predecessor()[order[k]]];
    const Vector3d here = at(beads.position[membrane.indices[order[k]]]);
    positions[order[k]] = before + images_.nearest_image(here - before);
  }
  return positions;
}

std::string Bonds::overstretched(const Chain& chain, const Beads& beads) const {
  const std::vector<Vector3d> positions = positions_of(chain, beads);
  const double longest = std::min(chain.law.max_length(), longest_);
  for (std::size_t k = 0; k + 1 < positions.size(); ++k) {
    const double r = (positions[k + 1] - positions[k]).norm();
    if (r < longest) continue;
    return fmt::format(
        "bond {} of chain {}, of beads {} and {}, is {:.4g} r_c long, allowed: less than {:.4g}; {}", k + 1,
        chain.id, chain.beads[k], chain.beads[k + 1], r, longest, look_at);
  }
  return fmt::format("chain {} is at no number; {}", chain.id, look_at);
}

std::string Bonds::overstretched(const Membrane& membrane, const Beads& beads) const {
  const std::vector<Vector3d> positions = positions_of(membrane, beads);
  for (const MembraneNetwork::SpringEdge& edge : membrane.network.edges()) {
    const double r = (positions[edge.b] - positions[edge.a]).norm();
    const double longest = std::min(edge.law.max_length(), longest_);
    if (r > 0 && r < longest) continue;
    return fmt::format(
        "the edge of membrane {} between beads {} and {} is {:.4g} r_c long, allowed: above 0, "
        "less than {:.4g}; {}",
        membrane.id, membrane.beads[edge.a], membrane.beads[edge.b], r, longest, look_at);
  }
  return fmt::format("a triangle of membrane {} has no area; {}", membrane.id, look_at);
}

std::vector<ChainObservation> Bonds::observe_chains(const Beads& beads) const {
  std::vector<ChainObservation> seen;
  seen.reserve(chains_.size());
  for (const Chain& chain : chains_) {
    ChainObservation& one = seen.emplace_back();
    one.positions = positions_of(chain, beads);
    const std::vector<Vector3d>& positions = one.positions;
    one.id = chain.id;
    one.beads = chain.beads;
    one.end_to_end = positions.back() - positions.front();
    for (const Vector3d& p : positions) one.centroid += p / static_cast<double>(positions.size());
    double square = 0;
    for (const Vector3d& p : positions) square += (p - one.centroid).squaredNorm();
    one.radius_of_gyration = std::sqrt(square / static_cast<double>(positions.size()));
    for (std::size_t k = 0; k + 1 < positions.size(); ++k) {
      const double r = (positions[k + 1] - positions[k]).norm();
      one.contour_length += r;
      one.longest_bond = std::max(one.longest_bond, r);
      one.energy += chain.law.energy(r);
    }
  }
  return seen;
}

std::vector<MembraneObservation> Bonds::observe_membranes(const Beads& beads) const {
  std::vector<MembraneObservation> seen;
  for (const Membrane& membrane : membranes_) {
    MembraneObservation& one = seen.emplace_back();
    one.id = membrane.id;
    one.beads = membrane.beads;
    one.mesh = membrane.placement.mesh;
    one.positions = positions_of(membrane, beads);
    one.area = area(one.positions, membrane.network.triangles());
    one.volume = volume(one.positions, membrane.network.triangles());
    one.reduced_volume = reduced_volume(one.area, one.volume);
    const double share = 1 / static_cast<double>(one.positions.size());
    one.lower = one.upper = one.positions.front();
    for (const Vector3d& p : one.positions) {
      one.centroid += share * p;
      one.lower = one.lower.cwiseMin(p);
      one.upper = one.upper.cwiseMax(p);
    }
    Eigen::Matrix3d gyration = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : one.positions)
      gyration += share * (p - one.centroid) * (p - one.centroid).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(gyration, Eigen::EigenvaluesOnly);
    one.gyration_radii = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    for (const MembraneNetwork::SpringEdge& edge : membrane.network.edges())
      one.longest_edge = std::max(one.longest_edge, (one.positions[edge.b] - one.positions[edge.a]).norm());
    one.energy = membrane.network.energy(one.positions);
  }
  return seen;
}

std::uint64_t Bonds::hash() const {
  std::uint64_t hash = mix64(chains_.size()) + 1;
  for (const Chain& chain : chains_) {
    hash = fold(fold(mix64(hash ^ chain.id), chain.law), chain.beads);
    for (const double component : chain.stretching_force) hash = fold(hash, component);
  }
  for (const Membrane& membrane : membranes_) {
    hash = fold(mix64(hash ^ membrane.id), membrane.beads);
    for (const MembraneNetwork::SpringEdge& edge : membrane.network.edges()) hash = fold(hash, edge.law);
    const MembraneStiffness& s = membrane.placement.stiffness;
    for (const double value :
         {s.bending_rigidity, s.flat ? 1.0 : 0.0, s.area_stiffness, s.local_area_stiffness,
          s.volume_stiffness, membrane.network.rest_area(), membrane.network.rest_volume()})
      hash = fold(hash, value);
  }
  return hash;
}

}  // namespace dmf::engine
