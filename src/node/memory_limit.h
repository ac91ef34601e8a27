#pragma once

namespace dmf::node {

/// From now on this process gets no more than so much memory besides what it has, MB: asking for more is an
/// exception then (std::bad_alloc), which fails one service call, and not the end of this machine. roscpp
/// takes the length of a list in a request at its word and fills as much memory before it looks whether the
/// request is as long. Does nothing in a build with a sanitizer, which needs address space by the terabyte.
void limit_memory(double megabytes);

/// Gives what was freed back to the system: after a run has ended, so that a node that lives for days does
/// not keep in pieces what its runs have taken one after the other.
void release_memory();

}  // namespace dmf::node
