#pragma once
#include <actionlib/server/action_server.h>
#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <string>

#include "controller/coordinator.h"
#include "controller_node/convert.h"
#include "yaml/invalid_input.h"

namespace dmf::controller_node {

/// What the servers of all kinds of operations share.
struct Workplace {
  controller::Coordinator& coordinator;
  controller::Limits defaults;
  /// Before an operation begins: the rail on. Throws InvalidInput when that can't be.
  std::function<void()> prepare;
  std::function<void()> drive;  ///< what the coordinator wants goes to the board, now
  std::function<std::string(controller::Channel)> explain;  ///< why a droplet does not move; may be empty
};

/// One kind of operation as an action. Many goals may be active at once: they are for different droplets.
template <class Action>
class OperationServer {
 public:
  OperationServer(ros::NodeHandle handle, const std::string& name, Workplace& workplace)
      : workplace_(workplace),
        server_(
            handle, name, [this](Handle goal) { start(goal); }, [this](Handle goal) { cancel(goal); },
            false) {
    server_.start();
  }

  /// Feedback of what is under way, results of what is over.
  void report() {
    for (auto active = active_.begin(); active != active_.end();) {
      const controller::Report report = workplace_.coordinator.report(active->first);
      if (report.status.state == controller::State::running) {
        typename actionlib::ActionServer<Action>::Feedback feedback;
        feedback.progress = report.status.progress;
        feedback.time_left = report.status.time_left;
        feedback.text = report.status.text;
        active->second.publishFeedback(feedback);
        ++active;
      } else {
        end(active->second, report);
        workplace_.coordinator.forget(active->first);
        active = active_.erase(active);
      }
    }
  }

 private:
  using Handle = typename actionlib::ActionServer<Action>::GoalHandle;
  using Result = typename actionlib::ActionServer<Action>::Result;

  void start(Handle goal) {
    try {
      workplace_.prepare();
      const controller::Coordinator::Key key =
          workplace_.coordinator.start(to_goal(*goal.getGoal(), workplace_.defaults));
      goal.setAccepted();
      active_[key] = goal;
      workplace_.drive();
    } catch (const InvalidInput& refused) {
      Result result;
      result.message = refused.what();
      goal.setRejected(result, result.message);
    }
  }

  void cancel(Handle goal) {
    for (const auto& [key, active] : active_)
      if (active == goal) workplace_.coordinator.cancel(key);
    workplace_.drive();
    report();
  }

  void end(Handle& goal, const controller::Report& report) {
    Result result;
    result.message = report.status.text;
    result.droplets = to_messages(report.droplets);
    switch (report.status.state) {
      case controller::State::succeeded:
        return goal.setSucceeded(result, result.message);
      case controller::State::cancelled:
        return goal.setCanceled(result, result.message);
      default:
        if (!report.droplets.empty()) {
          const std::string why = workplace_.explain(report.droplets.front().main);
          if (!why.empty()) result.message += ". The board says: " + why;
        }
        return goal.setAborted(result, result.message);
    }
  }

  Workplace& workplace_;
  std::map<controller::Coordinator::Key, Handle> active_;
  actionlib::ActionServer<Action> server_;  // last: it calls back as soon as it is there
};

}  // namespace dmf::controller_node
