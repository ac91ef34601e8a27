#pragma once
#include <functional>
#include <string>
#include <vector>

#include "chip/scene.h"
#include "tools/transport.h"

namespace dmf::tools {

/// One value of what a study varies.
struct VariedValue {
  std::string label;
  std::function<void(chip::Scene&)> apply;
};

/// A number that is measured on a run.
struct Quantity {
  const char* name;   ///< column of the CSV file
  const char* title;  ///< with its unit
  int decimals;
  std::function<double(const std::vector<TransportRecord>&)> measure;  ///< NaN: has not happened
  std::vector<const char*> lan = {};  ///< what Lan found, by value; may end early
  /// How far off Lan's single runs still counts as the same, where a tenth of them says nothing.
  double margin = 0;
  bool alike = false;  ///< what Lan says of it is not an order: all values of the study have it the same
};

/// A study: the scene of config/scenes that has its name, a value in it that is varied, and when a run is
/// over.
struct TransportStudy {
  const char* name;
  const char* about;
  const char* varied;  ///< "" for nothing
  std::vector<VariedValue> values;
  double limit;           ///< tau, TransportRun
  double goal;            ///< x, TransportRun
  double after_drop_off;  ///< tau, TransportRun
  std::vector<Quantity> quantities;
};

/// The studies of Lan's chapters 3 and 4 that follow a microparticle over the gradient.
const std::vector<TransportStudy>& transport_table();

}  // namespace dmf::tools
