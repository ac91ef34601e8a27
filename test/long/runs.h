#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

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

}  // namespace dmf::tools
