#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/bonds/bonds.h"

// How chains and membranes are saved, and what of saved ones is refused.

namespace dmf::engine {
namespace {

constexpr std::size_t most_vertices = 100'000;  // as membrane.h has it

void archive_kind(Archive& archive, SpringKind& kind) {
  auto number = static_cast<std::uint32_t>(kind);
  archive(number);
  if (number > static_cast<std::uint32_t>(SpringKind::fene))
    throw InvalidInput(fmt::format("saved state: spring {}, allowed: 0 to 2", number));
  kind = static_cast<SpringKind>(number);
}

void archive_chain(Archive& archive, Chain& chain) {
  archive(chain.id);
  archive_kind(archive, chain.spring.kind);
  archive(chain.spring.stiffness);
  archive(chain.spring.length);
  archive(chain.spring.max_length);
  archive(chain.spring.persistence_length);
  archive(chain.stretching_force);
  archive(chain.beads);
}

void archive_placement(Archive& archive, MembranePlacement& placement) {
  TriangleMesh mesh = placement.mesh ? *placement.mesh : TriangleMesh{};
  std::uint64_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
  archive(vertices);
  archive(triangles);
  if (archive.reading()) {
    archive.require_left(vertices, 3 * sizeof(double));
    archive.require_left(triangles, sizeof(TriangleMesh::Triangle));
    if (vertices > most_vertices || triangles > 2 * most_vertices)
      throw InvalidInput("saved state: a membrane of too many triangles");
    mesh.vertices.resize(vertices);
    mesh.triangles.resize(triangles);
  }
  for (Vector3d& vertex : mesh.vertices) archive(vertex);
  for (TriangleMesh::Triangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) archive(vertex);
  if (archive.reading()) placement.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  MembraneStiffness& s = placement.stiffness;
  archive_kind(archive, s.spring);
  archive(s.flat);
  for (double* number : {&s.shear_modulus, &s.max_stretch, &s.bending_rigidity, &s.area_stiffness,
                         &s.local_area_stiffness, &s.volume_stiffness, &s.volume_ratio})
    archive(*number);
}

void require_rising(const char* what, std::uint32_t id, std::uint32_t before, std::uint32_t next) {
  if (id <= before || id >= next)
    throw InvalidInput(fmt::format("saved state: {} {}, allowed: rising ids below {}", what, id, next));
}

}  // namespace

void Bonds::archive(Archive& archive) {
  archive(next_chain_);
  archive(next_membrane_);
  std::uint64_t count = chains_.size();
  archive(count);
  for (std::uint64_t k = 0; k < count; ++k) {
    Chain chain = archive.reading() ? Chain{} : chains_[k];
    archive_chain(archive, chain);
    if (!archive.reading()) continue;
    std::vector<std::string> wrong = violations(chain.spring);
    if (chain.beads.size() < 2) wrong.push_back("a chain of one bead");
    if (!chain.stretching_force.allFinite()) wrong.push_back("a chain pulled by no number");
    if (!wrong.empty()) throw InvalidInput(fmt::format("saved state: {}", fmt::join(wrong, "; ")));
    require_rising("chain", chain.id, k > 0 ? chains_.back().id : 0, next_chain_);
    chain.law = SpringLaw::of(chain.spring, parameters_.liquid.temperature);
    chains_.push_back(std::move(chain));
  }
  count = membranes_.size();
  archive(count);
  for (std::uint64_t k = 0; k < count; ++k) {
    MembranePlacement placement = archive.reading() ? MembranePlacement{} : membranes_[k].placement;
    std::uint32_t id = archive.reading() ? 0 : membranes_[k].id;
    std::vector<std::uint32_t> beads = archive.reading() ? std::vector<std::uint32_t>{} : membranes_[k].beads;
    archive(id);
    archive_placement(archive, placement);
    archive(beads);
    if (!archive.reading()) continue;
    const std::vector<std::string> wrong = violations(placement, parameters_);
    if (!wrong.empty()) throw InvalidInput(fmt::format("saved state: {}", fmt::join(wrong, "; ")));
    if (beads.size() != placement.mesh->vertices.size())
      throw InvalidInput("saved state: a membrane without a bead for each vertex");
    require_rising("membrane", id, k > 0 ? membranes_.back().id : 0, next_membrane_);
    bind_membrane(placement, std::move(beads));
    --next_membrane_;
    membranes_.back().id = id;
  }
}

void Bonds::require_sound(const Beads& beads) const {
  const std::uint32_t above = beads.id.empty() ? 0 : *std::max_element(beads.id.begin(), beads.id.end()) + 1;
  std::vector<bool> free(above, false);
  for (const std::uint32_t id : beads.id) free[id] = true;
  const auto check = [&](const char* what, std::uint32_t number, const std::vector<std::uint32_t>& ids) {
    for (const std::uint32_t id : ids) {
      if (id >= above || !free[id])
        throw InvalidInput(
            fmt::format("saved state: bead {} of {} {} is not there, or bound twice", id, what, number));
      free[id] = false;
    }
  };
  for (const Chain& chain : chains_) check("chain", chain.id, chain.beads);
  for (const Membrane& membrane : membranes_) check("membrane", membrane.id, membrane.beads);
}

}  // namespace dmf::engine
