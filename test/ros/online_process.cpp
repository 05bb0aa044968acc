// fork and exec, and the services of a nodelet manager.
#include "online_process.h"

#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpc.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "online_support.h"

namespace evolin::test {

namespace {

std::vector<std::string> managerCommand(const std::string& space, int threads) {
  ros::param::set(space + "/manager/num_worker_threads", threads);
  return {"rosrun", "nodelet", "nodelet", "manager", "__name:=manager", "__ns:=" + space};
}

}  // namespace

std::size_t listenersOf(const std::string& node, const std::string& topic) {
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  request[1] = node;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue uri;
  if (!ros::master::execute("lookupNode", request, response, uri, false)) {
    return 0;
  }
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(static_cast<std::string>(uri), host, port)) {
    return 0;
  }
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port));
  XmlRpc::XmlRpcValue caller;
  caller[0] = ros::this_node::getName();
  if (!client.execute("getBusInfo", caller, response) || response.size() < 3) {
    return 0;
  }
  std::size_t count = 0;
  for (int i = 0; i < response[2].size(); ++i) {
    XmlRpc::XmlRpcValue& link = response[2][i];
    if (static_cast<std::string>(link[2]) == "o" && static_cast<std::string>(link[4]) == topic) {
      ++count;
    }
  }
  return count;
}

Process::Process(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();  // NOLINT(cppcoreguidelines-prefer-member-initializer): its arguments come first
  if (pid_ < 0) {
    throw std::runtime_error("cannot start " + command.front());
  }
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // A shell that starts the tests in the background lets them, and so their children, ignore it.
    std::signal(SIGINT, SIG_DFL);
    if (getppid() == parent) {
      execvp(arguments.front(), arguments.data());
    }
    _exit(127);
  }
}

Process::~Process() {
  constexpr double kGrace = 10;
  if (!running()) {
    return;
  }
  send(SIGINT);
  if (!wait(kGrace)) {
    send(SIGKILL);
    wait(kGrace);
  }
}

void Process::send(int signal) const {
  if (!status_) {
    kill(pid_, signal);
  }
}

std::optional<int> Process::wait(double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!status_) {
    int status = 0;
    const pid_t ended = waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) {
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    } else if (std::chrono::steady_clock::now() >= deadline) {
      break;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  return status_;
}

Manager::Manager(const std::string& space, int threads)
    : space_(space), process_(managerCommand(space, threads)) {
  const std::string name = space + "/manager";
  const auto ready = [&] {
    return ros::service::exists(name + "/load_nodelet", false) && listenersOf(name, "/rosout") > 0;
  };
  const ::testing::AssertionResult result = waitFor("nodelet manager " + name, ready);
  if (!result) {
    throw std::runtime_error(result.message());
  }
}

bool Manager::load(const std::string& name, const std::string& type,
                   const std::map<std::string, std::string>& remappings) {
  nodelet::NodeletLoadRequest request;
  request.name = space_ + "/" + name;
  request.type = type;
  for (const auto& [from, to] : remappings) {
    request.remap_source_args.push_back(space_ + "/" + from);
    request.remap_target_args.push_back(to.front() == '/' ? to : space_ + "/" + to);
  }
  const auto answer = tryService<nodelet::NodeletLoad>(space_ + "/manager/load_nodelet", request);
  return answer && answer->success != 0;
}

bool Manager::unload(const std::string& name) {
  nodelet::NodeletUnloadRequest request;
  request.name = space_ + "/" + name;
  const auto answer =
      tryService<nodelet::NodeletUnload>(space_ + "/manager/unload_nodelet", request);
  return answer && answer->success != 0;
}

::testing::AssertionResult waitForListener(const std::string& node, const std::string& topic,
                                           std::size_t count) {
  return waitFor(std::to_string(count) + " listeners to " + topic + " of " + node,
                 [&] { return listenersOf(node, topic) >= count; });
}

::testing::AssertionResult Manager::waitForListener(const std::string& topic,
                                                    std::size_t count) const {
  return ::evolin::test::waitForListener(space_ + "/manager", space_ + "/" + topic, count);
}

}  // namespace evolin::test
