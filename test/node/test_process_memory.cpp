#include "node/process_memory.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <thread>
#include <vector>

namespace dmf::node {
namespace {

using Block = std::vector<char>;

/// In a thread, which has a heap of its own, as the node's threads do.
template <class Work>
void in_a_thread(const Work& work) {
  std::thread(work).join();
}

TEST(ProcessMemory, InUseIsWhatWasAskedForAndNotFreed) {
  in_a_thread([] {
    const MemoryUse before = memory_use();
    std::vector<Block> small(200, Block(100'000, 1));
    Block large(30'000'000, 1);
    const MemoryUse held = memory_use();
    EXPECT_NEAR(held.in_use - before.in_use, 50, 0.5);
    EXPECT_NEAR(held.resident - before.resident, 50, 1);
    small = std::vector<Block>();
    large = Block();
    EXPECT_NEAR(memory_use().in_use, before.in_use, 0.5);
  });
}

TEST(ProcessMemory, WhatWasFreedIsGivenBackHoweverLargeTheBlocksWereThatItSaw) {
  give_freed_memory_back();
  in_a_thread([] {
    { const Block large(30'000'000, 1); }  // from here on glibc would keep 60 MB
    const double before = memory_use().resident;
    {
      const std::vector<Block> small(200, Block(100'000, 1));
      EXPECT_GT(memory_use().resident - before, 19);
    }
    EXPECT_NEAR(memory_use().resident, before, 1);
  });
}

TEST(ProcessMemory, WhatWasFreedInTheMiddleIsGivenBackOnRequest) {
  in_a_thread([] {
    const double before = memory_use().resident;
    std::vector<Block> small(200, Block(100'000, 1));
    for (std::size_t k = 0; k < small.size(); k += 2) small[k] = Block();
    EXPECT_GT(memory_use().resident - before, 19);
    release_memory();
    EXPECT_NEAR(memory_use().resident - before, 10, 1);
  });
}

}  // namespace
}  // namespace dmf::node
