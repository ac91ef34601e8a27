// Moves the droplet on one channel to another: rosrun dmf_sim move_droplet 0 5
#include <actionlib/client/simple_action_client.h>
#include <dmf_sim/MoveDropletAction.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "move_droplet_example");
  if (argc != 3) return 1;
  actionlib::SimpleActionClient<dmf_sim::MoveDropletAction> client("chip_controller/move_droplet");
  client.waitForServer();
  dmf_sim::MoveDropletGoal goal;
  goal.channel = std::stoul(argv[1]);
  goal.target = std::stoul(argv[2]);
  client.sendGoal(goal, {}, {}, [](const dmf_sim::MoveDropletFeedbackConstPtr& feedback) {
    ROS_INFO("%3.0f %%, %.1f s left: %s", 100 * feedback->progress, feedback->time_left,
             feedback->text.c_str());
  });
  client.waitForResult();
  ROS_INFO("%s", client.getResult()->message.c_str());
  return client.getState() == actionlib::SimpleClientGoalState::SUCCEEDED ? 0 : 1;
}
