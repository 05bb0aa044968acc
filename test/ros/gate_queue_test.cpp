// Callbacks wait in order until the gate opens, and go straight through from then on.
#include "gate_queue.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <vector>

namespace evolin::ros_shell {
namespace {

class Note : public ros::CallbackInterface {
 public:
  Note(int number, std::vector<int>* notes) : number_(number), notes_(notes) {}

  CallResult call() override {
    notes_->push_back(number_);
    return Success;
  }

 private:
  int number_;
  std::vector<int>* notes_;
};

class GateQueueTest : public ::testing::Test {
 protected:
  void add(int number, std::uint64_t owner) {
    gate_.addCallback(boost::make_shared<Note>(number, &notes_), owner);
  }

  std::vector<int> called() {
    target_->callAvailable();
    return notes_;
  }

  boost::shared_ptr<ros::CallbackQueue> target_ = boost::make_shared<ros::CallbackQueue>();
  GateQueue gate_{target_};
  std::vector<int> notes_;
};

TEST_F(GateQueueTest, KeepsWhatComesBeforeItOpens) {
  add(1, 10);
  add(2, 11);
  EXPECT_TRUE(target_->isEmpty());
  EXPECT_TRUE(called().empty());
  gate_.open();
  add(3, 10);
  EXPECT_EQ(called(), (std::vector<int>{1, 2, 3}));
}

TEST_F(GateQueueTest, ForgetsWhatItsOwnerTakesBack) {
  add(1, 10);
  add(2, 11);
  gate_.removeByID(10);
  gate_.open();
  EXPECT_EQ(called(), std::vector<int>{2});
  add(3, 10);
  add(4, 11);
  gate_.removeByID(11);
  EXPECT_EQ(called(), (std::vector<int>{2, 3}));
}

TEST_F(GateQueueTest, MayBeOpenedTwice) {
  add(1, 10);
  gate_.open();
  gate_.open();
  EXPECT_EQ(called(), std::vector<int>{1});
}

}  // namespace
}  // namespace evolin::ros_shell
