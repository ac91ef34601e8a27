#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

/// What every file of this folder defines once: reads `size` bytes as its kind of input, which may say
/// anything. Refusals are caught; whatever else is thrown, an assertion and a sanitizer's report are
/// findings. With -DDMF_FUZZ=ON libFuzzer calls it, otherwise replay.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace dmf {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the program when what was accepted is not what it should be.
inline void require(bool holds, const char* claim) {
  if (holds) return;
  std::cerr << "does not hold: " << claim << std::endl;
  std::abort();
}

}  // namespace dmf
