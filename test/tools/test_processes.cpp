#include "tools/processes.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>

namespace dmf::tools {
namespace {

namespace fs = std::filesystem;

/// A folder in which processes leave marks for each other.
class Marks {
 public:
  explicit Marks(const std::string& name) : folder_(testing::TempDir() + "dmf_processes_" + name) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void leave(const std::string& mark) const { std::ofstream(folder_ + "/" + mark); }
  /// @throws std::runtime_error when nobody leaves it in ten seconds.
  void await(const std::string& mark) const {
    for (int k = 0; !fs::exists(folder_ + "/" + mark); ++k) {
      if (k == 1000) throw std::runtime_error(mark + " never came");
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

 private:
  std::string folder_;
};

Works works_of(std::size_t count, int at_a_time, std::map<std::size_t, std::string>& answers) {
  Works works;
  works.count = count;
  works.at_a_time = at_a_time;
  works.name = [](std::size_t which) { return "work " + std::to_string(which); };
  works.answered = [&answers](std::size_t which, const std::string& answer) { answers[which] = answer; };
  works.watch = [](const WorkDone&) {};
  return works;
}

TEST(Processes, EveryWorkIsAnsweredOnceWhateverTheAnswersHold) {
  std::map<std::size_t, std::string> answers;
  Works works = works_of(7, 3, answers);
  // Larger than what a pipe holds, empty, and with bytes that end strings.
  works.work = [](std::size_t which) { return std::string(which * 40000, static_cast<char>(which % 2)); };
  run_in_processes(works);
  ASSERT_EQ(answers.size(), 7u);
  for (const auto& [which, answer] : answers) EXPECT_EQ(answer, works.work(which)) << which;
  EXPECT_NO_THROW(run_in_processes(works_of(0, 3, answers)));
}

TEST(Processes, SoManyAreUnderWayAtATime) {
  const Marks marks("side_by_side");
  std::map<std::size_t, std::string> answers;
  Works works = works_of(2, 2, answers);
  works.work = [&marks](std::size_t which) {
    marks.leave(std::to_string(which));
    marks.await(std::to_string(1 - which));
    return std::string();
  };
  EXPECT_NO_THROW(run_in_processes(works)) << "each waits for the other";
}

TEST(Processes, WhatOneDoesToItselfTheOthersDontFeel) {
  int changed = 0;
  std::map<std::size_t, std::string> answers;
  Works works = works_of(3, 1, answers);
  works.work = [&changed](std::size_t which) {
    changed += 1;
    return std::to_string(10 * static_cast<int>(which) + changed);
  };
  run_in_processes(works);
  EXPECT_EQ(answers, (std::map<std::size_t, std::string>{{0, "1"}, {1, "11"}, {2, "21"}}));
  EXPECT_EQ(changed, 0);
}

TEST(Processes, ShareDoneIsSeenWhileAWorkIsUnderWay) {
  const Marks marks("share");
  std::map<std::size_t, std::string> answers;
  Works works = works_of(2, 1, answers);
  works.work = [&marks](std::size_t which) {
    if (which == 1) return std::string();
    tell_share_done(0.25);  // was done before
    tell_share_done(0.75);
    marks.await("seen");
    return std::string();
  };
  WorkDone seen, last;
  works.watch = [&](const WorkDone& done) {
    if (answers.empty() && done.in_all == 0.75) {
      seen = done;
      marks.leave("seen");
    }
    last = done;
  };
  run_in_processes(works);
  EXPECT_EQ(seen.in_all, 0.75);
  EXPECT_EQ(seen.this_time, 0.5);
  EXPECT_EQ(last.in_all, 2);
  EXPECT_EQ(last.this_time, 1.75);
}

TEST(Processes, TheyEndWithTheOneThatBeganThem) {
  const Marks marks("killed");
  int life[2];
  ASSERT_EQ(pipe(life), 0);
  const pid_t child = fork();
  if (child == 0) {
    std::map<std::size_t, std::string> answers;
    Works works = works_of(1, 1, answers);
    works.work = [&marks](std::size_t) {
      marks.leave("under way");
      marks.await("its end");  // as long as that takes
      return std::string();
    };
    run_in_processes(works);
    _exit(0);
  }
  close(life[1]);
  marks.await("under way");
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  // The other end closes when nobody has it open any more.
  pollfd other_end{life[0], POLLIN, 0};
  EXPECT_EQ(poll(&other_end, 1, 5000), 1) << "its work lives on";
  EXPECT_NE(other_end.revents & POLLHUP, 0);
  close(life[0]);
}

}  // namespace
}  // namespace dmf::tools
