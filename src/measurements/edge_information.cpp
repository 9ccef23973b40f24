#include "edge_information.hpp"

#include <fmt/format.h>

#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

struct TagOrder {
  const char* tag;
  const char* order;
};
constexpr std::array<TagOrder, 2> kTagOrders{
    {{"EDGE_SE2", "Ω11 Ω12 Ω13 Ω22 Ω23 Ω33"}, {"EDGE2", "Ω11 Ω12 Ω22 Ω33 Ω13 Ω23"}}};

}  // namespace

Eigen::Matrix3d information_of(const std::array<double, 6>& v, GraphFormat order) {
  if (order == GraphFormat::toro) {
    return information_of({v[0], v[1], v[4], v[2], v[5], v[3]}, GraphFormat::g2o);
  }
  Eigen::Matrix3d information;
  information << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
  return information;
}

std::optional<Eigen::Matrix3d> EdgeInformation::read(const std::array<double, 6>& values,
                                                     GraphFormat order, std::size_t line) {
  Edges& edges = edges_[static_cast<std::size_t>(order)];
  const GraphFormat other = order == GraphFormat::g2o ? GraphFormat::toro : GraphFormat::g2o;
  ++edges.count;
  if (is_positive_definite(information_of(values, other))) ++edges.fit_other_order;
  const Eigen::Matrix3d information = information_of(values, order);
  if (is_positive_definite(information)) return information;
  edges.refused.push_back(line);
  return std::nullopt;
}

void EdgeInformation::tell(const G2oFault& fault) const {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edges& edges = edges_[i];
    const TagOrder& own = kTagOrders[i];
    const TagOrder& other = kTagOrders[1 - i];
    if (edges.refused.empty()) continue;
    if (edges.fit_other_order == edges.count) {
      fault(edges.refused.front(),
            fmt::format("the information matrix is not positive definite, as of {} of {} {} lines "
                        "({}), and all are in the order of {} ({}); expected that tag, or the "
                        "order of this one",
                        edges.refused.size(), edges.count, own.tag, own.order, other.tag,
                        other.order));
      continue;
    }
    for (const std::size_t line : edges.refused) {
      fault(line, "the information matrix is not positive definite");
    }
  }
}

}  // namespace fathom
