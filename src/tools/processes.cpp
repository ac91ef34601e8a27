#include "tools/processes.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace dmf::tools {
namespace {

/// What a work tells of itself while it is under way, in memory that it shares with who waits for it.
struct Share {
  std::atomic<double> first, latest;
};
static_assert(std::atomic<double>::is_always_lock_free, "a lock would not be shared");

Share* own_share = nullptr;

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), fmt::format("can't start a run: {}", what));
}

struct Unmap {
  std::size_t count;
  void operator()(Share* shares) const { munmap(shares, count * sizeof(Share)); }
};
using Shares = std::unique_ptr<Share[], Unmap>;

Shares shared_memory(std::size_t count) {
  void* const memory =
      mmap(nullptr, count * sizeof(Share), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) fail("mmap");
  return {static_cast<Share*>(memory), Unmap{count}};
}

enum ExitStatus { worked = 0, threw = 1, not_told = 2 };

void write_all(int file, const std::string& text) {
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t now = write(file, text.data() + written, text.size() - written);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) _exit(not_told);
    written += static_cast<std::size_t>(now);
  }
}

/// The life of a process that does one work.
[[noreturn]] void do_work(const Works& works, std::size_t which, pid_t parent, int answer_to) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(not_told);
  ExitStatus status = worked;
  std::string answer;
  try {
    answer = works.work(which);
  } catch (const std::exception& problem) {
    answer = problem.what();
    status = threw;
  }
  write_all(answer_to, answer);
  std::fflush(nullptr);
  // Nothing of the copied process is taken down: that is its original's business.
  _exit(status);
}

class Processes {
 public:
  explicit Processes(const Works& works)
      : works_(works), shares_(shared_memory(std::max<std::size_t>(1, works.count))) {}
  ~Processes() {
    for (const Process& process : running_) {
      kill(process.id, SIGKILL);
      waitpid(process.id, nullptr, 0);
      close(process.answer);
    }
  }
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  void run() {
    for (std::size_t next = 0; next < works_.count || !running_.empty();) {
      while (next < works_.count && failure_.empty() &&
             running_.size() < static_cast<std::size_t>(works_.at_a_time))
        start(next++);
      if (running_.empty()) break;
      listen();
      works_.watch(done());
    }
    if (!failure_.empty()) throw std::runtime_error(failure_);
  }

 private:
  struct Process {
    std::size_t which;
    pid_t id;
    int answer;  ///< what it writes can be read here
    std::string text;
  };

  void start(std::size_t which) {
    int ends[2];
    if (pipe(ends) != 0) fail("pipe");
    // What stands in a buffer would be written twice.
    std::fflush(nullptr);
    const pid_t parent = getpid(), child = fork();
    if (child == 0) {
      own_share = &shares_[which];
      do_work(works_, which, parent, ends[1]);
    }
    close(ends[1]);
    if (child < 0) {
      close(ends[0]);
      fail("fork");
    }
    running_.push_back({which, child, ends[0], {}});
  }

  /// Waits for what the running ones say, not longer than until it is time for another look at them.
  void listen() {
    constexpr int kLooksApart = 200;  // ms
    std::vector<pollfd> ears;
    for (const Process& process : running_) ears.push_back({process.answer, POLLIN, 0});
    if (poll(ears.data(), ears.size(), kLooksApart) <= 0) return;
    for (std::size_t k = running_.size(); k-- > 0;) {
      if (ears[k].revents == 0) continue;
      char buffer[4096];
      const ssize_t count = read(running_[k].answer, buffer, sizeof buffer);
      if (count > 0) running_[k].text.append(buffer, static_cast<std::size_t>(count));
      if (count == 0) end(k);
    }
  }

  /// That one of the running has closed its end.
  void end(std::size_t k) {
    const Process process = std::move(running_[k]);
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(k));
    close(process.answer);
    int status = 0;
    while (waitpid(process.id, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == worked) {
      shares_[process.which].latest = 1;
      works_.answered(process.which, process.text);
    } else if (failure_.empty())
      failure_ = fmt::format("{}: {}", works_.name(process.which), failure_of(process, status));
  }

  static std::string failure_of(const Process& process, int status) {
    if (WIFSIGNALED(status))
      return fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    return process.text.empty() ? "ended without an answer" : process.text;
  }

  WorkDone done() const {
    WorkDone sum;
    for (std::size_t k = 0; k < works_.count; ++k) {
      sum.in_all += shares_[k].latest;
      sum.this_time += shares_[k].latest - shares_[k].first;
    }
    return sum;
  }

  const Works& works_;
  Shares shares_;  ///< by work
  std::vector<Process> running_;
  std::string failure_;
};

}  // namespace

void run_in_processes(const Works& works) { Processes(works).run(); }

void tell_share_done(double share) {
  if (!own_share) return;
  if (own_share->latest == 0) own_share->first = share;
  own_share->latest = share;
}

}  // namespace dmf::tools
