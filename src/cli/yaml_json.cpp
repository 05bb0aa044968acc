// Node by node.
#include "yaml_json.h"

namespace evolin::cli {

using Json = nlohmann::ordered_json;

Json toJson(const YAML::Node& node) {
  if (node.IsMap()) {
    Json object = Json::object();
    for (const auto& entry : node) {
      object[entry.first.Scalar()] = toJson(entry.second);
    }
    return object;
  }
  if (node.IsSequence()) {
    Json list = Json::array();
    for (const auto& entry : node) {
      list.push_back(toJson(entry));
    }
    return list;
  }
  if (!node.IsScalar()) {
    return nullptr;
  }
  Json value = Json::parse(node.Scalar(), nullptr, false);
  return value.is_discarded() ? Json(node.Scalar()) : value;
}

}  // namespace evolin::cli
