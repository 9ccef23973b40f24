#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "fathom/core/forked_child.hpp"

namespace fathom {

/// A message begins with its kind and the size of its text.
inline constexpr std::size_t kMessageHead = 1 + sizeof(std::uint64_t);

/// With this status a child ends that finds no memory where the system allows less than its limit.
inline constexpr int kCutMemoryStatus = 87;

/// The kind of a message that says what of the environment failed the child.
inline constexpr char kEnvironmentFault = '\x01';

/// What a child has of its parent: the ends of the pipes to it, and its number.
struct ChildSide {
  int messages = -1;
  int printed = -1;
  int parent = 0;
};

/// The life of a child from the fork on, as run_child says. What it throws must not reach the code
/// around the fork, which is the parent's.
[[noreturn]] void be_child(const ChildSide& side, const ChildLimits& limits,
                           const std::function<void(const MessagePipe&)>& action) noexcept;

}  // namespace fathom
