// Names of the protocols.
#include "evolin_ros/metrics/protocol.h"

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

std::string toString(Protocol protocol) {
  return protocol == Protocol::kEvolin ? "evolin" : "paper";
}

Protocol parseProtocol(const std::string& text) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    if (text == toString(protocol)) {
      return protocol;
    }
  }
  throw Error("unknown protocol " + quote(text) + ": expected evolin or paper");
}

}  // namespace evolin
