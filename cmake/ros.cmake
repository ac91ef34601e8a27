# Messages, services and what a ROS workspace needs to know about this package.

# catkin keeps the environment of its first configuration for the tests, and leaves folders out of it that do not exist
# yet. Without this one the first build's tests can't import the messages.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/devel/lib/python3/dist-packages)

# genmsg leaves libraries nothing to link: targets that include a generated header depend on
# ${dmf_sim_EXPORTED_TARGETS} and on ${catkin_EXPORTED_TARGETS}.
find_package(catkin REQUIRED COMPONENTS
  actionlib
  actionlib_msgs
  diagnostic_msgs
  geometry_msgs
  message_generation
  roscpp
  rosgraph_msgs
  sensor_msgs
  std_msgs
  std_srvs
  tf2_ros
  visualization_msgs)

add_message_files(FILES
  Capacitance.msg
  CheckpointFile.msg
  ChipState.msg
  Command.msg
  Droplet.msg
  DropletArray.msg
  ElectrodeArray.msg
  ElectrodeOutline.msg
  ElectrodeState.msg
  Event.msg
  Layout.msg
  Microparticle.msg
  MicroparticleArray.msg
  OperationLimits.msg
  RunRecord.msg
  Scene.msg
  SceneFile.msg
  SensedDroplet.msg
  SensedDropletArray.msg
  StateHash.msg)

add_action_files(FILES
  Dispense.action
  Merge.action
  Mix.action
  MoveDroplet.action
  RunProtocol.action
  Split.action)

add_service_files(FILES
  AddMicroparticle.srv
  Checkpoint.srv
  DetectShorts.srv
  DispenseDroplet.srv
  ExplainDroplet.srv
  GetLayout.srv
  GetState.srv
  InjectFault.srv
  LoadPattern.srv
  Remove.srv
  SetBodyForces.srv
  SetDisabledChannels.srv
  SetElectrodeVoltages.srv
  SetElectrodes.srv
  SetHv.srv
  SetWettability.srv
  Step.srv)

generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs std_msgs)

catkin_package(CATKIN_DEPENDS
  actionlib
  actionlib_msgs
  diagnostic_msgs
  geometry_msgs
  message_runtime
  roscpp
  rosgraph_msgs
  sensor_msgs
  std_msgs
  std_srvs
  tf2_ros
  visualization_msgs)

# genmsg puts the generated headers on every target's include path, the engine's too; src/node asks for them itself.
set_property(DIRECTORY PROPERTY INCLUDE_DIRECTORIES "")

catkin_install_python(
  PROGRAMS scripts/demo_controller.py scripts/summarize_run.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY config launch DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
