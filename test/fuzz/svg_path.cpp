// The data of an SVG path, the points of a polygon and a transform.
#include "chip/svg_path.h"
#include "target.h"
#include "yaml/invalid_input.h"

namespace {

void check(const std::vector<Eigen::Vector2d>& outline) {
  for (const auto& corner : outline)
    dmf::require((corner.array().abs() <= 1e6).all(),
                 "every corner lies within the coordinates that are allowed");
}

template <class Action>
void attempt(const Action& action) {
  try {
    action();
  } catch (const dmf::InvalidInput&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = dmf::text_of(data, size);
  attempt([&] { check(dmf::chip::closed_path(text)); });
  attempt([&] { check(dmf::chip::polygon_points(text)); });
  attempt([&] { dmf::chip::svg_transform(text); });
  return 0;
}
