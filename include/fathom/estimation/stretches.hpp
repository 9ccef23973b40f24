#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace fathom {

/// The stretches of a log between its holes, and what leads from one to another: a tree. At first
/// every stretch hangs on the one before it by the hole between them; a loop over a hole takes its
/// place (docs/absolute_measurements.md).
class Stretches {
 public:
  /// The next node; the step to it is a hole that a loop may take the place of, or not.
  void add_node(bool after_hole);

  /// The last hole on the way between two nodes that nothing has crossed: the node after it.
  std::optional<std::size_t> open_hole(std::size_t a, std::size_t b) const;

  /// The nodes, all of them in order, that this hole alone holds to node 0.
  std::vector<bool> held_by(std::size_t hole) const;

  /// A loop between two nodes takes the place of the hole on the way between them.
  void replace(std::size_t hole, std::size_t a, std::size_t b);

  /// No loop takes the place of the holes on the way between two nodes any more.
  void keep(std::size_t a, std::size_t b);

  /// Whether any hole is left that a loop may take the place of.
  bool has_open() const;

 private:
  /// What stretch i + 1 began with.
  struct Link {
    std::size_t node = 0;  ///< the one after the hole
    std::size_t a = 0;     ///< stretches
    std::size_t b = 0;
    bool is_open = true;
  };

  /// Of each stretch, the link by which it is reached from `root`, and the stretch before it.
  struct Reached {
    std::size_t link = 0;
    std::size_t from = 0;
    bool is_reached = false;
  };
  std::vector<Reached> reached(std::size_t root, std::optional<std::size_t> without) const;
  std::vector<std::size_t> links_between(std::size_t a, std::size_t b) const;
  std::size_t link_of(std::size_t hole) const;

  std::vector<std::size_t> stretch_of_;  ///< of every node
  std::vector<Link> links_;
};

}  // namespace fathom
