#pragma once

namespace dmf::node {

/// From now on this process gets no more than so much memory besides what it has, MB: asking for more is an
/// exception then (std::bad_alloc), which fails one service call, and not the end of this machine. roscpp
/// takes the length of a list in a request at its word and fills as much memory before it looks whether the
/// request is as long. Does nothing in a build with a sanitizer, which needs address space by the terabyte.
void limit_memory(double megabytes);

/// From now on freed memory at the end of a heap goes back to the system. By default glibc keeps the more of
/// it at the end of each thread's heap the larger the blocks were that it has seen, up to 64 MB, so that a
/// node that hardly got a processor for a while has more memory ever after.
void give_freed_memory_back();

/// Gives what was freed in the middle of heaps back too: after a run has ended, so that a node that lives for
/// days does not keep in pieces what its runs have taken one after the other.
void release_memory();

/// What this process takes, MB.
struct MemoryUse {
  double in_use = 0;    ///< of the heap, by malloc's account; a few hundred kB that it keeps at hand count
  double kept = 0;      ///< freed, and not given back to the system or never touched
  double resident = 0;  ///< pages in memory, those of the program and its libraries among them
};
MemoryUse memory_use();

}  // namespace dmf::node
