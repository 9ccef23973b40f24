// SE-Sync (Rosen, Carlone, Bandeira and Leonard 2019) on a g2o file, for the estimator `command`:
//
//     fathom solve GRAPH.g2o --estimator command --set 'estimator.command=se_sync {input} {output}'
//
// SE-Sync minimises another cost: squared distances of rotation matrices (4 sin²(e_θ / 2)), and
// positions with one weight for both axes that is turned with the pose.

#include <SESync/SESync.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace {

// Its own reader takes a line FIX for a measurement. Weights are those of that reader.
SESync::measurements_t edges_of(const char* file) {
  std::ifstream in(file);
  SESync::measurements_t edges;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    if (tag != "EDGE_SE2") continue;
    SESync::RelativePoseMeasurement z;
    double x, y, theta, xx, xy, xt, yy, yt, tt;
    words >> z.i >> z.j >> x >> y >> theta >> xx >> xy >> xt >> yy >> yt >> tt;
    if (!words) throw std::runtime_error("no edge: " + line);
    z.t = Eigen::Vector2d(x, y);
    z.R = Eigen::Rotation2Dd(theta).toRotationMatrix();
    z.tau = 2.0 * (xx * yy - xy * xy) / (xx + yy);  // 2 / trace of the inverse
    z.kappa = tt;
    edges.push_back(z);
  }
  return edges;
}

std::size_t pose_count(const SESync::measurements_t& edges) {
  std::size_t last = 0;
  for (const auto& z : edges) last = std::max({last, z.i, z.j});
  return last + 1;
}

// xhat = [t_0 … t_{n−1} | R_0 … R_{n−1}], 2 rows.
void write_poses(const SESync::Matrix& xhat, Eigen::Index n, const char* file) {
  std::ofstream out(file);
  out.precision(17);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double theta = std::atan2(xhat(1, n + 2 * k), xhat(0, n + 2 * k));
    out << "VERTEX_SE2 " << k << ' ' << xhat(0, k) << ' ' << xhat(1, k) << ' ' << theta << '\n';
  }
  if (!out.flush()) throw std::runtime_error(std::string(file) + " cannot be written");
}

int solve(const char* input, const char* output) {
  const SESync::measurements_t edges = edges_of(input);
  SESync::SESyncOpts options;
  options.num_threads = 1;
  const SESync::SESyncResult result = SESync::SESync(edges, options);
  if (result.status != SESync::GlobalOpt) throw std::runtime_error("no certified optimum");
  write_poses(result.xhat, static_cast<Eigen::Index>(pose_count(edges)), output);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: se_sync INPUT.g2o OUTPUT.g2o\n");
    return 2;
  }
  try {
    return solve(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "se_sync: error: %s\n", error.what());
    return 1;
  }
}
