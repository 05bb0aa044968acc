// Which optional parts of a frame a plug-in asks for.
#pragma once

namespace evolin {

/// Without a plug-in's wish a node does not subscribe to these and a reader does not decode them.
struct Needs {
  bool depth = false;
  bool camera = false;
  bool pose = false;
};

}  // namespace evolin
