#pragma once
#include "yaml/units.h"

namespace dmf::engine {

using dmf::Units;

}  // namespace dmf::engine
