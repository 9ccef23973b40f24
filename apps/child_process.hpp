#pragma once

#include <functional>
#include <string>

namespace fathom {

/// Does an action in a process of its own, since a library that it calls may crash on a damaged
/// file, and waits for it. What the action prints and writes is there afterwards; what it changes
/// in memory is not. Throws InputError with the message of an InputError that it threw, and one
/// that begins with `source` where it crashed. No thread may have been started before.
void in_child_process(const std::string& source, const std::function<void()>& action);

}  // namespace fathom
