#include "engine/beads.h"

namespace dmf::engine {

void Beads::add(const Record& at, const Record& moving, std::uint32_t bead_id, std::uint8_t of_species) {
  if (of_species > 0 && species.empty()) species.assign(size(), 0);
  if (of_species > 0 || !species.empty()) species.push_back(of_species);
  position.push_back(at);
  predicted.push_back(moving);
  velocity.push_back(moving);
  force.push_back({});
  listed.push_back(at);
  id.push_back(bead_id);
}

void Beads::reserve_more(std::size_t count) {
  for (AlignedVector<Record>* array : {&position, &predicted, &velocity, &force, &listed})
    array->reserve(array->size() + count);
  id.reserve(id.size() + count);
}

void Beads::reorder(const std::vector<std::uint32_t>& order) {
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(order.size());
  for (AlignedVector<Record>* array : {&position, &predicted, &velocity, &force}) {
    listed.resize(order.size());
    const Record* from = array->data();
    Record* to = listed.data();
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t k = 0; k < count; ++k) to[k] = from[order[k]];
    array->swap(listed);
  }
  listed.resize(order.size());
  scratch_id_.resize(order.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < count; ++k) scratch_id_[k] = id[order[k]];
  id.swap(scratch_id_);
  if (species.empty()) return;
  scratch_species_.resize(order.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < count; ++k) scratch_species_[k] = species[order[k]];
  species.swap(scratch_species_);
}

}  // namespace dmf::engine
