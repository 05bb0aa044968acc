// Bags with an index, by rosbag's own view.
#include "bag_source.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <utility>

#include "conversions.h"
#include "evolin_ros/base/text.h"

namespace evolin::ros_shell {

namespace {

class IndexedBags : public BagSource {
 public:
  explicit IndexedBags(const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) {
      names_ += (names_.empty() ? "" : ", ") + file.string();
      auto bag = std::make_unique<rosbag::Bag>();
      bag->open(file.string(), rosbag::bagmode::Read);
      bags_.push_back(std::move(bag));
    }
    listTopics();
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }

  void peek(const std::string& topic, const std::function<bool(const BagMessage&)>& look) override {
    guarded([&] {
      rosbag::View view;
      addTo(&view, {topic}, ros::TIME_MIN, ros::TIME_MAX);
      for (const rosbag::MessageInstance& message : view) {
        if (!look(BagMessage(message))) {
          return;
        }
      }
    });
  }

  void choose(const std::vector<std::string>& topics, const BagWindow& window) override {
    guarded([&] {
      const double end = window.start + window.duration.value_or(0);
      const ros::Time from = begin_ + ros::Duration(window.start);
      const ros::Time to = window.duration ? begin_ + ros::Duration(end) : ros::TIME_MAX;
      current_.reset();
      at_once_.clear();
      view_ = std::make_unique<rosbag::View>();
      addTo(view_.get(), topics, from, to);
      ranks_.clear();
      for (const rosbag::ConnectionInfo* connection : view_->getConnections()) {
        ranks_.emplace(connection->topic, ranks_.size());
      }
    });
  }

  std::optional<BagMessage> next() override {
    std::optional<BagMessage> message;
    guarded([&] {
      if (view_ == nullptr) {
        return;
      }
      if (!at_once_.empty()) {
        at_once_.pop_front();
      }
      if (at_once_.empty()) {
        collectAtOnce();
      }
      if (!at_once_.empty()) {
        message.emplace(at_once_.front());
      }
    });
    return message;
  }

  std::string problem() const override { return {}; }

 private:
  void listTopics() {
    rosbag::View all;
    for (const auto& bag : bags_) {
      all.addQuery(*bag);
    }
    std::map<std::string, BagTopic> by_name;
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      BagTopic& topic = by_name[connection->topic];
      topic.name = connection->topic;
      topic.type = connection->datatype;
    }
    for (auto& [name, topic] : by_name) {
      rosbag::View one;
      addTo(&one, {name}, ros::TIME_MIN, ros::TIME_MAX);
      topic.messages = one.size();
      topics_.push_back(topic);
    }
    begin_ = all.size() > 0 ? all.getBeginTime() : ros::TIME_MIN;
  }

  /// The next messages of one time, by topic as the recorder came to know them. A view gives them
  /// in any order, and rosbag reads a chunk again whenever it gets back to it: the image of one
  /// frame and the annotation of the one before it mostly share a chunk.
  void collectAtOnce() {
    constexpr std::size_t kMostAtOnce = 64;
    if (!current_) {
      current_.emplace(view_->begin());
    }
    const rosbag::View::iterator end = view_->end();
    while (*current_ != end && at_once_.size() < kMostAtOnce &&
           (at_once_.empty() || (*current_)->getTime() == at_once_.front().getTime())) {
      at_once_.push_back(**current_);
      ++*current_;
    }
    at_once_.sort([this](const rosbag::MessageInstance& a, const rosbag::MessageInstance& b) {
      return ranks_.at(a.getTopic()) < ranks_.at(b.getTopic());
    });
  }

  void addTo(rosbag::View* view, const std::vector<std::string>& topics, const ros::Time& from,
             const ros::Time& to) const {
    for (const auto& bag : bags_) {
      view->addQuery(*bag, rosbag::TopicQuery(topics), from, to);
    }
  }

  template <class Work>
  void guarded(const Work& work) const {
    try {
      work();
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {  // rosbag's, boost's and roscpp's own
      throw Error(names_ + ": cannot be read: " + error.what());
    }
  }

  std::string names_;
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::vector<BagTopic> topics_;
  ros::Time begin_;
  std::unique_ptr<rosbag::View> view_;
  std::map<std::string, std::size_t> ranks_;  ///< of the view's topics
  std::optional<rosbag::View::iterator> current_;
  std::list<rosbag::MessageInstance> at_once_;  ///< the first was given out last
};

}  // namespace

std::unique_ptr<BagSource> openBags(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    if (!std::filesystem::is_regular_file(file)) {
      throw Error(file.string() + ": no such file, expected a bag");
    }
  }
  std::string names;
  for (const std::filesystem::path& file : files) {
    names += (names.empty() ? "" : ", ") + file.string();
  }
  try {
    return std::make_unique<IndexedBags>(files);
  } catch (const rosbag::BagUnindexedException&) {
    if (files.size() == 1) {
      return openUnindexedBag(files.front());
    }
    throw Error(names +
                ": one of these has no index (was its recording cut off?); 'rosbag "
                "reindex' mends it");
  } catch (const rosbag::BagException& error) {
    throw Error(names + ": cannot be read as a bag: " + error.what());
  }
}

}  // namespace evolin::ros_shell
