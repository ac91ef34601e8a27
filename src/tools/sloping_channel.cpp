#include "tools/sloping_channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "chip/experiment.h"
#include "chip/label_shape.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

using engine::LabelGrid;
using engine::Vector3d;

constexpr double looks_apart = 0.5;  // tau

/// What lies outside of the channel above (side 1) or below (-1) z = 0.
chip::LabelShape solid_outside(const Slopes& slopes, const engine::Domain& domain, double side) {
  const double begin = slopes.middle - 0.5 * slopes.run, end = slopes.middle + 0.5 * slopes.run;
  const double far = domain.upper.x();
  const double out = side > 0 ? domain.upper.z() : -domain.lower.z();
  chip::LabelShape shape;
  shape.kind = chip::LabelShape::Kind::prism;
  shape.axis = 1;
  for (const auto& [x, z] : {std::pair{-far, out},
                             {far, out},
                             {far, slopes.wide},
                             {end, slopes.wide},
                             {begin, slopes.narrow},
                             {-begin, slopes.narrow},
                             {-end, slopes.wide},
                             {-far, slopes.wide}})
    shape.outline.push_back({x, side * z});
  return shape;
}

/// Sections of a grid without anything in them. What is between the widest and the narrowest ones narrows
/// when the narrowest comes next along x.
std::vector<ChannelSection> sections_of(const LabelGrid& grid) {
  std::vector<ChannelSection> sections(static_cast<std::size_t>(grid.voxels[0]));
  const int count = grid.voxels[0];
  double widest = 0, narrowest = 1e300;
  for (int x = 0; x < count; ++x) {
    ChannelSection& section = sections[static_cast<std::size_t>(x)];
    section.x = grid.origin.x() + (x + 0.5) * grid.voxel_size.x();
    for (int z = 0; z < grid.voxels[2]; ++z)
      if (grid.labels[grid.index(x, 0, z)] == LabelGrid::fluid) section.height += grid.voxel_size.z();
    widest = std::max(widest, section.height);
    narrowest = std::min(narrowest, section.height);
  }
  for (int x = 0; x < count; ++x) {
    int next = x;
    const auto height = [&](int of) { return sections[static_cast<std::size_t>(of % count)].height; };
    while (height(next) > narrowest && height(next) < widest) ++next;
    const bool to_narrow = height(next) <= narrowest;
    sections[static_cast<std::size_t>(x)].reach = next == x
                                                      ? (to_narrow ? Reach::narrow : Reach::wide)
                                                      : (to_narrow ? Reach::narrowing : Reach::widening);
  }
  return sections;
}

}  // namespace

double Slopes::angle() const { return std::atan2(wide - narrow, run) / degree; }

void lay_slopes(const Slopes& slopes, chip::Scene& scene) {
  const engine::Domain& domain = scene.parameters.domain;
  LabelGrid grid = chip::grid_over(domain, scene.parameters.label_grid.grid->voxel_size);
  for (const double side : {-1.0, 1.0})
    chip::label(grid, domain, solid_outside(slopes, domain, side), Vector3d::Zero(), LabelGrid::solid);
  scene.parameters.label_grid.grid = std::make_shared<const LabelGrid>(std::move(grid));
}

ReachMeans SlopingChannelResult::over(Reach reach) const {
  ReachMeans means;
  double volume = 0, beads = 0, momentum = 0, chains = 0, count = 0;
  for (const ChannelSection& section : sections) {
    if (section.reach != reach) continue;
    count += 1;
    means.height += section.height;
    volume += section.volume;
    beads += section.beads;
    momentum += section.momentum;
    chains += section.chains;
    means.stretch_square += section.stretch_square;
    means.end_to_end_square += section.end_to_end_square;
    means.off_centre += section.off_centre;
  }
  means.height /= count;
  means.velocity = momentum / beads;
  means.density = beads / volume;
  for (double* mean : {&means.stretch_square, &means.end_to_end_square, &means.off_centre}) *mean /= chains;
  return means;
}

SlopingChannelResult run_sloping_channel(const SlopingChannelRun& run) {
  const engine::Parameters& parameters = run.scene.parameters;
  const engine::Domain& domain = parameters.domain;
  const LabelGrid& grid = *parameters.label_grid.grid;
  SlopingChannelResult result;
  result.sections = sections_of(grid);
  const auto section_at = [&](double x) -> ChannelSection& {
    const double from =
        std::fmod(std::fmod(x - grid.origin.x(), domain.size().x()) + domain.size().x(), domain.size().x());
    return result
        .sections[std::min(result.sections.size() - 1, static_cast<std::size_t>(from / grid.voxel_size.x()))];
  };
  chip::Experiment experiment(run.scene, {1, "auto"}, run.seed);
  const auto go_on = [&](double time) {
    for (auto k = std::llround(time / parameters.time_step); k > 0; --k) experiment.step();
  };
  go_on(run.settle);
  const int looks = std::max(1, static_cast<int>(std::lround(run.measure / looks_apart)));
  double beads = 0, chains = 0;
  for (int look = 0; look < looks; ++look) {
    go_on(looks_apart);
    const auto snapshot = experiment.observe({true});
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      ChannelSection& section = section_at(snapshot->positions[k].x());
      section.beads += 1;
      section.momentum += snapshot->velocities[k].x();
      result.temperature += snapshot->velocities[k].y() * snapshot->velocities[k].y();
    }
    beads += static_cast<double>(snapshot->positions.size());
    for (const engine::ChainObservation& chain : snapshot->chains) {
      ChannelSection& section = section_at(chain.centroid.x());
      const double along = chain.end_to_end.x();
      section.chains += 1;
      section.stretch_square += along * along;
      section.end_to_end_square += chain.end_to_end.squaredNorm();
      section.off_centre += 2 * std::abs(chain.centroid.z()) / section.height;
      result.stretch_square += along * along;
      const double bonds = static_cast<double>(chain.positions.size()) - 1;
      result.longest =
          std::max(result.longest, std::abs(along) / (bonds * run.scene.chains.at(0).spring.max_length));
      result.straightest = std::max(result.straightest, chain.end_to_end.norm() / chain.contour_length);
      chains += 1;
    }
  }
  for (ChannelSection& section : result.sections)
    section.volume = section.height * domain.size().y() * grid.voxel_size.x() * looks;
  result.stretch_square /= chains;
  result.temperature /= beads;
  return result;
}

void write_sections(const std::string& file, const SlopingChannelResult& result) {
  double flow = 0;  // of mass through every section: what the velocity would be if the density were even
  double beads = 0, volume = 0;
  for (const ChannelSection& section : result.sections) {
    flow += section.momentum / static_cast<double>(result.sections.size());
    beads += section.beads;
    volume += section.volume;
  }
  std::ofstream out(file);
  out << "x,height,velocity,theory,density,chains,stretch_square,end_to_end_square,off_centre\n";
  for (const ChannelSection& section : result.sections)
    out << fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", section.x,
                       section.height, section.momentum / section.beads,
                       flow * volume / (section.volume * beads), section.beads / section.volume,
                       section.chains, section.stretch_square / section.chains,
                       section.end_to_end_square / section.chains, section.off_centre / section.chains);
}

}  // namespace dmf::tools
