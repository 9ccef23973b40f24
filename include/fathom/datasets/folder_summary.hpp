#pragma once

#include <string>
#include <vector>

#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// What `fathom check DIR` says of an image folder; one line each, no final full stop.
struct FolderSummary {
  std::vector<std::string> facts;
  std::vector<std::string> warnings;
  std::vector<std::string> faults;  ///< what a run would refuse
};

/// Summarises a survey and looks for what is legal but probably wrong. Every picture is read as a
/// run reads it.
FolderSummary summarise_frames(const FrameSource& source);

}  // namespace fathom
