// Whether matched lines determine a motion at all.
#pragma once

#include <string>
#include <vector>

#include "two_view_line.h"

namespace evolin {

/// What the lines leave open, as a sentence, or "" when they determine the motion. The translation
/// is seen only along the normals of the planes through a camera and a line seen: parallel lines,
/// lines through one point and lines in one plane with the camera have normals that span no space.
/// So that noise does not hide this, normals must span space beyond what the pixel noise of
/// segments of their lengths makes up. Then the motion must be known to 5 degrees and a tenth of
/// the lines' distance at a noise of one pixel.
std::string openMotion(const std::vector<TwoViewLine>& lines, const std::vector<Support>& support,
                       const Pose& motion, const Camera& camera);

/// Whether a motion that is not open would be so without a single one of the lines: one wrong match
/// is enough to have made it up.
bool hangsOnOneLine(const std::vector<TwoViewLine>& lines, const std::vector<Support>& support,
                    const Pose& motion, const Camera& camera);

}  // namespace evolin
