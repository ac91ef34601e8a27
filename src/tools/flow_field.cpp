#include "tools/flow_field.h"

#include <fmt/format.h>

#include <cmath>

namespace dmf::tools {

FlowField::FlowField() : along_(columns * rows), across_(columns * rows) {}

void FlowField::add(std::vector<Cell>& plane, double s, double z, double across, double v_s, double v_z) {
  const int column = static_cast<int>(std::floor((s + reach) / cell)),
            row = static_cast<int>(std::floor(z / cell));
  if (std::abs(across) > half_thickness || column < 0 || column >= columns || row < 0 || row >= rows) return;
  Cell& found = plane[static_cast<std::size_t>(row * columns + column)];
  found.beads += 1;
  found.momentum_s += v_s;
  found.momentum_z += v_z;
}

void FlowField::add(const Eigen::Vector3d& relative, const Eigen::Vector3d& velocity) {
  add(along_, relative.x(), relative.z(), relative.y(), velocity.x(), velocity.z());
  add(across_, relative.y(), relative.z(), relative.x(), velocity.y(), velocity.z());
}

void FlowField::archive(engine::Archive& archive) {
  archive(looks_);
  archive(along_);
  archive(across_);
}

Eigen::Vector2d FlowField::mean_velocity(Plane plane, const Eigen::AlignedBox2d& region) const {
  const std::vector<Cell>& cells = plane == Plane::along ? along_ : across_;
  double beads = 0;
  Eigen::Vector2d momentum = Eigen::Vector2d::Zero();
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      if (!region.contains(middle(row, column))) continue;
      const Cell& one = cells[static_cast<std::size_t>(row * columns + column)];
      beads += one.beads;
      momentum += Eigen::Vector2d(one.momentum_s, one.momentum_z);
    }
  return beads > 0 ? Eigen::Vector2d(momentum / beads) : Eigen::Vector2d::Constant(NAN);
}

std::string FlowField::as_csv() const {
  std::string text = "plane,s,z,density,v_s,v_z\n";
  const double volume = looks_ * cell * cell * 2 * half_thickness;
  for (const auto& [name, plane] : {std::make_pair("xz", &along_), std::make_pair("yz", &across_)})
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const Cell& one = (*plane)[static_cast<std::size_t>(row * columns + column)];
        if (one.beads <= 0) continue;
        const Eigen::Vector2d at = middle(row, column);
        text += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", name, at.x(), at.y(),
                            one.beads / volume, one.momentum_s / one.beads, one.momentum_z / one.beads);
      }
  return text;
}

}  // namespace dmf::tools
