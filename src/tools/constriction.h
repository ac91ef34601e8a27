#pragma once
#include <cstdint>
#include <functional>

#include "chip/scene.h"

namespace dmf::tools {

/// A cell that a body force drives along a periodic channel in x, through its throat. Single-threaded;
/// reduced units.
struct ConstrictionRun {
  chip::Scene scene;           ///< with one membrane
  double begin = -4, end = 4;  ///< of the throat along x, r_c
  double time = 150;           ///< tau; it ends sooner when the cell has come half a channel beyond
  std::uint64_t seed = 1;
};

/// The cell at one time.
struct ConstrictionSample {
  double time;          ///< tau
  double x;             ///< of its centroid, continuous, r_c
  double length;        ///< along x, r_c
  double width;         ///< root of its extents along y and z, r_c
  double elongation;    ///< longest radius of gyration over the middle one: 1 for a disc however it lies
  double area, volume;  ///< of those when placed
};

struct ConstrictionResult {
  double passage = 0;  ///< time from when its front is in the throat until its rear is out; NaN: not through
  double elongation = 0;  ///< largest on its way
  double recovered = 0;   ///< mean of it 5 r_c or more behind the throat; NaN: not through
  double width = 0;       ///< smallest on its way, r_c
  double speed_before = 0,
         speed_inside = 0;                  ///< mean of its centroid until its front is in, and in the throat
  double area_error = 0, volume_error = 0;  ///< largest, of those when placed
  double area = 0, volume = 0;              ///< means, of those when placed
  double leaked = 0;  ///< beads of liquid that changed sides, of those inside after the first tau
};

/// @param sample  called every tau. @throws engine::Instability, engine::InvalidInput.
ConstrictionResult run_constriction(const ConstrictionRun& run,
                                    const std::function<void(const ConstrictionSample&)>& sample = {});

}  // namespace dmf::tools
