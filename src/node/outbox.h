#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "node/frame.h"

namespace dmf::node {

/// What the engine thread leaves for the publisher thread. The engine never waits here: a frame that was not
/// taken yet is replaced by the newer one, and so are a reading and the clock. Commands, events and state
/// hashes are kept, in order, until taken; when nobody takes them for long, those after the first
/// kMostWaiting are counted and no longer kept.
class Outbox {
 public:
  static constexpr std::size_t kMostWaiting = 100'000;  ///< commands, events, and hashes

  struct Delivery {
    std::shared_ptr<const Frame> frame;  ///< null when there is no new one
    std::vector<CommandNote> commands;
    std::vector<EventNote> events;
    std::vector<StateHashNote> hashes;
    std::optional<CapacitanceNote> capacitance;  ///< newest that was not taken
    std::uint64_t clock = 0;                     ///< newest ROS time, ns; 0 when there is no news
    std::uint64_t lost = 0;                      ///< commands, events and hashes that found no room
  };

  void put(std::shared_ptr<const Frame> frame) {
    change([&](Delivery& d) {
      d.clock = frame->stamp;
      d.frame = std::move(frame);
    });
  }
  void put(CommandNote command) {
    change([&](Delivery& d) { keep(d, d.commands, std::move(command)); });
  }
  void put(EventNote event) {
    change([&](Delivery& d) { keep(d, d.events, std::move(event)); });
  }
  void put(StateHashNote hash) {
    change([&](Delivery& d) { keep(d, d.hashes, std::move(hash)); });
  }
  void put(CapacitanceNote reading) {
    change([&](Delivery& d) { d.capacitance = std::move(reading); });
  }
  void put_clock(std::uint64_t nanoseconds) {
    change([&](Delivery& d) { d.clock = nanoseconds; });
  }

  /// Takes what there is, waiting for it no longer than `timeout`. False when there was nothing.
  bool take(Delivery& delivery, std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return filled_ || closed_; });
    delivery = std::exchange(waiting_, {});
    return std::exchange(filled_, false);
  }

  /// Wakes whoever waits in take(), now and from then on.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  template <class Note>
  static void keep(Delivery& delivery, std::vector<Note>& line, Note note) {
    if (line.size() < kMostWaiting)
      line.push_back(std::move(note));
    else
      ++delivery.lost;
  }

  template <class Change>
  void change(const Change& apply) {
    const std::lock_guard lock(mutex_);
    apply(waiting_);
    filled_ = true;
    changed_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  Delivery waiting_;
  bool filled_ = false;
  bool closed_ = false;
};

}  // namespace dmf::node
