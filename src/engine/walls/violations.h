#pragma once
#include <string>
#include <vector>

#include "engine/parameters.h"

namespace dmf::engine {

/// What is wrong with the label grid, each as "key: value, allowed: range"; the domain is sound. Empty when
/// there is none.
std::vector<std::string> label_grid_violations(const Parameters& parameters);

}  // namespace dmf::engine
