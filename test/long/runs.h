#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tools/study.h"

namespace dmf::tools {

/// A study's table in a folder of its own that starts empty.
inline std::string fresh_table(const std::string& name) {
  const std::string file = testing::TempDir() + "dmf_long_" + name + ".csv";
  std::filesystem::remove(file);
  return file;
}

inline StudyOptions two_at_a_time() {
  StudyOptions options;
  options.jobs = 2;
  return options;
}

}  // namespace dmf::tools
