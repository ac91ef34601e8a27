#pragma once
#include "engine/kernels/kernels.h"

namespace dmf::engine {

/// The same three loops in plain scalar double precision, without lanes: the oracle for the vector kernels,
/// and what they are timed against.
Kernels reference_kernels(DissipativeWeight weight, PairModel model);

}  // namespace dmf::engine
