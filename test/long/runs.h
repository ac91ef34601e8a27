#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/cases.h"

namespace dmf::tools {

/// Two runs at a time, into a folder of the test's own that starts empty.
inline StudyOptions two_at_a_time(const std::string& name, int seeds) {
  StudyOptions options;
  options.jobs = 2;
  options.seeds = seeds;
  options.output = testing::TempDir() + "dmf_long_" + name;
  std::filesystem::remove_all(options.output);
  return options;
}

/// One seed of some cases of a study.
inline StudyOptions cases_of(const std::string& study, const std::vector<std::string>& cases) {
  StudyOptions options = two_at_a_time(study, 1);
  std::filesystem::create_directories(options.output);
  options.only = cases;
  return options;
}

/// What a study has found of a quantity of one case; a failure and NaN when it has not.
inline double value_of(const Findings& findings, const std::string& of, const std::string& quantity) {
  for (const Finding& finding : findings)
    if (finding.of == of && finding.quantity == quantity && finding.happened() > 0)
      return finding.mean().mean;
  ADD_FAILURE() << of << ": no " << quantity;
  return NAN;
}

}  // namespace dmf::tools
