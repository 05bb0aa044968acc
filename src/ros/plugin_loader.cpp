// pluginlib behind a header without ROS.
#include "plugin_loader.h"

#include <pluginlib/class_loader.hpp>

#include <algorithm>

#include "evolin_ros/association/verified_associator.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

struct PluginLoader::Loaders {
  pluginlib::ClassLoader<LineDetector> detectors{"evolin_ros", "evolin::LineDetector"};
  pluginlib::ClassLoader<LineAssociator> associators{"evolin_ros", "evolin::LineAssociator"};
};

namespace {

template <class Base>
std::string joinedNames(pluginlib::ClassLoader<Base>* loader) {
  std::vector<std::string> names = loader->getDeclaredClasses();
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

/// `keep_alive` owns the loader and thereby the library's code.
template <class Base>
std::shared_ptr<Base> load(const std::string& kind, const std::string& name,
                           pluginlib::ClassLoader<Base>* loader,
                           std::shared_ptr<const void> keep_alive) {
  if (!loader->isClassAvailable(name)) {
    throw Error("unknown " + kind + " '" + name + "'; did you mean '" +
                nearestWord(name, loader->getDeclaredClasses()) +
                "'? Known: " + joinedNames(loader));
  }
  try {
    auto unique = loader->createUniqueInstance(name);
    Base* object = unique.get();
    auto owner = std::make_shared<decltype(unique)>(std::move(unique));
    return std::shared_ptr<Base>(object, [owner, keep_alive](Base*) mutable {
      owner.reset();
      keep_alive.reset();
    });
  } catch (const pluginlib::PluginlibException& error) {
    throw Error(kind + " '" + name + "' does not load: " + error.what());
  }
}

template <class Base>
std::filesystem::path libraryOf(const std::string& kind, const std::string& name,
                                pluginlib::ClassLoader<Base>* loader) {
  try {
    return loader->getClassLibraryPath(name);
  } catch (const pluginlib::PluginlibException& error) {
    throw Error(kind + " '" + name + "' has no library: " + error.what());
  }
}

template <class Base>
std::vector<PluginInfo> list(const std::string& kind, pluginlib::ClassLoader<Base>* loader,
                             const std::shared_ptr<const void>& keep_alive) {
  std::vector<std::string> names = loader->getDeclaredClasses();
  std::sort(names.begin(), names.end());
  std::vector<PluginInfo> infos;
  for (const std::string& name : names) {
    PluginInfo info{name, loader->getClassDescription(name), loader->getClassPackage(name), {}};
    try {
      info.why_unavailable = load(kind, name, loader, keep_alive)->whyUnavailable();
    } catch (const Error& error) {
      info.why_unavailable = error.what();
    }
    infos.push_back(std::move(info));
  }
  return infos;
}

}  // namespace

PluginLoader::PluginLoader() {
  try {
    loaders_ = std::make_shared<Loaders>();
  } catch (const pluginlib::PluginlibException& error) {
    throw Error(std::string("plug-ins cannot be listed: ") + error.what());
  }
}

PluginLoader::~PluginLoader() = default;

std::shared_ptr<LineDetector> PluginLoader::loadDetector(const std::string& name) {
  return load("detector", name, &loaders_->detectors, loaders_);
}

std::shared_ptr<LineAssociator> PluginLoader::loadAssociator(const std::string& name) {
  return std::make_shared<VerifiedAssociator>(
      name, load("associator", name, &loaders_->associators, loaders_));
}

std::filesystem::path PluginLoader::detectorLibrary(const std::string& name) {
  return libraryOf("detector", name, &loaders_->detectors);
}

std::filesystem::path PluginLoader::associatorLibrary(const std::string& name) {
  return libraryOf("associator", name, &loaders_->associators);
}

std::vector<PluginInfo> PluginLoader::listDetectors() {
  return list("detector", &loaders_->detectors, loaders_);
}

std::vector<PluginInfo> PluginLoader::listAssociators() {
  return list("associator", &loaders_->associators, loaders_);
}

}  // namespace evolin
