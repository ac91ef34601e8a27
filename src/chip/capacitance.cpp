#include "chip/capacitance.h"

#include <algorithm>
#include <cmath>

#include "chip/polygon.h"
#include "engine/noise.h"

namespace dmf::chip {

double liquid_capacitance(const Scene& scene) {
  return scene.electrowetting.dielectric_capacitance(surface_tension(scene));
}

double filler_capacitance(const Scene& scene) {
  const engine::Domain& domain = scene.parameters.domain;
  if (!domain.has_top_plate()) return 0;
  const double gap = domain.size().z() * scene.units.length_m;
  const double filler = kVacuumPermittivity * scene.sensing.filler_permittivity / gap;
  const double dielectric = liquid_capacitance(scene);
  return dielectric * filler / (dielectric + filler);
}

PadCapacitance::PadCapacitance(const Scene& scene)
    : liquid_(liquid_capacitance(scene) * scene.units.area_m2()),
      filler_(filler_capacitance(scene) * scene.units.area_m2()) {
  const engine::PlateCells cells(scene.parameters.domain);
  for (const Electrode& electrode : scene.layout.electrodes()) {
    std::vector<Part> parts;
    const auto box = bounding_box(electrode.outline);
    const int lower_column = static_cast<int>((box.min().x() - cells.lower_x) / cells.length_x);
    const int upper_column = static_cast<int>((box.max().x() - cells.lower_x) / cells.length_x);
    const int lower_row = static_cast<int>((box.min().y() - cells.lower_y) / cells.length_y);
    const int upper_row = static_cast<int>((box.max().y() - cells.lower_y) / cells.length_y);
    for (int row = lower_row; row <= upper_row; ++row) {
      for (int column = lower_column; column <= upper_column; ++column) {
        const double x = cells.lower_x + column * cells.length_x, y = cells.lower_y + row * cells.length_y;
        const Polygon cell{{x, y},
                           {x + cells.length_x, y},
                           {x + cells.length_x, y + cells.length_y},
                           {x, y + cells.length_y}};
        const double area = shared_area(electrode.outline, cell);
        if (area > 0) parts.push_back({column, row, area});
      }
    }
    pad_areas_.push_back(area(electrode.outline));
    parts_.push_back(std::move(parts));
  }
}

std::vector<double> PadCapacitance::wetted_areas(const engine::WettedArea& wetted) const {
  std::vector<double> areas;
  for (const std::vector<Part>& parts : parts_) {
    double area = 0;
    for (const Part& part : parts) {
      if (wetted.at(part.column, part.row)) area += part.area;
    }
    areas.push_back(area);
  }
  return areas;
}

std::vector<double> PadCapacitance::capacitances(const engine::WettedArea& wetted) const {
  std::vector<double> values = wetted_areas(wetted);
  for (std::size_t index = 0; index < values.size(); ++index) {
    const double wet = std::min(values[index], pad_areas_[index]);
    values[index] = liquid_ * wet + filler_ * (pad_areas_[index] - wet);
  }
  return values;
}

CapacitanceReading read_channels(std::vector<double> capacitance, const Scene& scene, std::uint64_t seed,
                                 std::uint64_t step) {
  const engine::StepKey key = engine::step_key(seed, step, engine::Stream::sensing);
  for (std::size_t index = 0; index < capacitance.size(); ++index) {
    const std::uint32_t channel = scene.layout.electrodes()[index].channel;
    capacitance[index] +=
        scene.sensing.offset + scene.sensing.noise * engine::gaussian_noise(key, channel, 0);
  }
  return {step, std::move(capacitance)};
}

}  // namespace dmf::chip
