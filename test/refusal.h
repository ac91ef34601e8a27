#pragma once
#include <gtest/gtest.h>

#include <string>

#include "yaml/invalid_input.h"

namespace dmf {

/// What InvalidInput an action throws says; fails the test and is empty when it throws nothing.
template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const InvalidInput& refused) {
    return refused.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

/// gtest without gmock: the text holds a part.
inline ::testing::AssertionResult holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "`" << part << "` is not in:\n" << text;
}

}  // namespace dmf
