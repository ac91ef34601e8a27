#include "node/process_memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>

namespace dmf::node {

void limit_memory([[maybe_unused]] double megabytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  rlim_t pages = 0;  // of address space; the kernel has no limit for what is resident
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t bytes =
      pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + static_cast<rlim_t>(megabytes * 1e6);
  rlimit limit{};
  if (pages == 0 || ::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur <= bytes) return;
  limit.rlim_cur = bytes;
  ::setrlimit(RLIMIT_AS, &limit);
#endif
}

void give_freed_memory_back() {
  constexpr int kAtMost = 128 * 1024;  // bytes: glibc's own default, but fixed
  ::mallopt(M_TRIM_THRESHOLD, kAtMost);
}

void release_memory() { ::malloc_trim(0); }

MemoryUse memory_use() {
#if __GLIBC_PREREQ(2, 33)
  const struct mallinfo2 heap = ::mallinfo2();
#else
  const struct mallinfo heap = ::mallinfo();
#endif
  const auto megabytes = [](auto bytes) { return static_cast<double>(bytes) * 1e-6; };
  std::size_t pages = 0, resident_pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident_pages;
  return {megabytes(heap.uordblks) + megabytes(heap.hblkhd), megabytes(heap.fordblks),
          megabytes(resident_pages) * static_cast<double>(::sysconf(_SC_PAGESIZE))};
}

}  // namespace dmf::node
