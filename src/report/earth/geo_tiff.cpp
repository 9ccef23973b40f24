#include "fathom/report/geo_tiff.hpp"

#include <algorithm>

#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"

#ifdef FATHOM_GEOTIFF
#include <geo_normalize.h>
#include <geotiffio.h>
#include <xtiffio.h>
#endif

namespace fathom {

#ifdef FATHOM_GEOTIFF
namespace {

/// GDAL's tag for the value of pixels without data, which geographic programs read.
constexpr std::uint32_t kNoDataTag = 42113;

struct CloseTiff {
  void operator()(TIFF* file) const { XTIFFClose(file); }
};

/// The smallest overview has no side above this.
constexpr int kOverview_px = 256;

// Within 4 GB of offsets also where nothing can be compressed; overviews add a third.
bool needs_big_tiff(const MosaicPlan& plan) {
  return static_cast<double>(plan.size.width) * plan.size.height > 2.9e9;
}

cv::Size tiles_of(const cv::Size& size, int side_px) {
  return {(size.width + side_px - 1) / side_px, (size.height + side_px - 1) / side_px};
}

// Each pixel is the mean of those of four that are seen.
cv::Mat halved(const cv::Mat& fine) {
  cv::Mat coarse(fine.rows / 2, fine.cols / 2, CV_8U, cv::Scalar(kUnseen));
  for (int v = 0; v < coarse.rows; ++v) {
    const unsigned char* upper = fine.ptr(2 * v);
    const unsigned char* lower = fine.ptr(2 * v + 1);
    for (int u = 0; u < coarse.cols; ++u) {
      int sum = 0;
      int seen = 0;
      const int left = 2 * u;
      for (const int grey : {upper[left], upper[left + 1], lower[left], lower[left + 1]}) {
        if (grey == kUnseen) continue;
        sum += grey;
        ++seen;
      }
      if (seen > 0) coarse.ptr(v)[u] = static_cast<unsigned char>((sum + seen / 2) / seen);
    }
  }
  return coarse;
}

void declare_no_data(TIFF* file) {
  static char name[] = "GDALNoDataValue";
  static const TIFFFieldInfo field[] = {
      {kNoDataTag, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_ASCII, FIELD_CUSTOM, 1, 0, name}};
  TIFFMergeFieldInfo(file, field, 1);
  TIFFSetField(file, kNoDataTag, std::to_string(kUnseen).c_str());
}

void set_format(TIFF* file, const cv::Size& size, int side_px) {
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(size.width));
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(size.height));
  TIFFSetField(file, TIFFTAG_TILEWIDTH, static_cast<std::uint32_t>(side_px));
  TIFFSetField(file, TIFFTAG_TILELENGTH, static_cast<std::uint32_t>(side_px));
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(file, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(file, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  declare_no_data(file);
}

bool set_place(TIFF* file, const EarthFrame& earth, const MosaicPlan& plan) {
  const double side_m = plan.metres_per_pixel;
  const Eigen::Vector2d corner = earth.easting_northing(plan.top_left_m);
  const double scale[3] = {side_m, side_m, 0.0};
  const double tie_point[6] = {0.0, 0.0, 0.0, corner.x(), corner.y(), 0.0};
  TIFFSetField(file, TIFFTAG_GEOPIXELSCALE, 3, scale);
  TIFFSetField(file, TIFFTAG_GEOTIEPOINTS, 6, tie_point);
  GTIF* keys = GTIFNew(file);
  if (keys == nullptr) return false;
  GTIFKeySet(keys, GTModelTypeGeoKey, TYPE_SHORT, 1, ModelTypeProjected);
  GTIFKeySet(keys, GTRasterTypeGeoKey, TYPE_SHORT, 1, RasterPixelIsArea);
  GTIFKeySet(keys, GTCitationGeoKey, TYPE_ASCII, 0, earth.name().c_str());
  GTIFKeySet(keys, ProjectedCSTypeGeoKey, TYPE_SHORT, 1, earth.epsg());
  GTIFKeySet(keys, ProjLinearUnitsGeoKey, TYPE_SHORT, 1, Linear_Meter);
  const bool is_written = GTIFWriteKeys(keys) != 0;
  GTIFFree(keys);
  return is_written;
}

}  // namespace

struct GeoTiff::File {
  std::filesystem::path path;
  std::unique_ptr<TIFF, CloseTiff> tiff;
  cv::Size size;
  int side_px = 0;
  std::vector<bool> is_written;  ///< by tile, row by row

  [[noreturn]] void fail() const {
    throw InputError(path.string(), "cannot be written; is the disk full?");
  }

  void put(std::size_t tile, const cv::Mat& pixels) const {
    const auto number = static_cast<std::uint32_t>(tile);
    if (TIFFWriteEncodedTile(tiff.get(), number, pixels.data,
                             static_cast<tmsize_t>(pixels.total())) < 0) {
      fail();
    }
  }

  void end_directory() const {
    if (TIFFWriteDirectory(tiff.get()) == 0) fail();
  }

  // The mosaic by halves, each a directory behind that of the one it is made from, whose tiles are
  // read again: memory is five tiles.
  void write_overviews() const {
    cv::Size fine = size;
    for (std::uint16_t level = 0; std::max(fine.width, fine.height) > kOverview_px; ++level) {
      // Without a map of the file in memory.
      const std::unique_ptr<TIFF, CloseTiff> finer(XTIFFOpen(path.c_str(), "rm"));
      if (!finer || TIFFSetDirectory(finer.get(), level) == 0) fail();
      const cv::Size coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
      set_format(tiff.get(), coarse, side_px);
      TIFFSetField(tiff.get(), TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
      const cv::Size tiles = tiles_of(coarse, side_px);
      std::size_t tile = 0;
      for (int row = 0; row < tiles.height; ++row) {
        for (int column = 0; column < tiles.width; ++column) {
          put(tile++, halved(four_tiles(finer.get(), tiles_of(fine, side_px), row, column)));
        }
      }
      end_directory();
      fine = coarse;
    }
  }

 private:
  // Those that a tile of half the resolution covers; unseen beyond the border.
  cv::Mat four_tiles(TIFF* finer, const cv::Size& tiles, int row, int column) const {
    cv::Mat four(2 * side_px, 2 * side_px, CV_8U, cv::Scalar(kUnseen));
    cv::Mat one(side_px, side_px, CV_8U);
    for (int r = 0; r < 2 && 2 * row + r < tiles.height; ++r) {
      for (int c = 0; c < 2 && 2 * column + c < tiles.width; ++c) {
        const auto number =
            static_cast<std::uint32_t>((2 * row + r) * tiles.width + 2 * column + c);
        const auto bytes = static_cast<tmsize_t>(one.total());
        if (TIFFReadEncodedTile(finer, number, one.data, bytes) != bytes) fail();
        one.copyTo(four({c * side_px, r * side_px, side_px, side_px}));
      }
    }
    return four;
  }
};

GeoTiff::GeoTiff(const std::filesystem::path& path, const EarthFrame& earth, const MosaicPlan& plan,
                 int side_px)
    : file_(std::make_unique<File>()) {
  // Their messages would go to standard error, beside the one line of an error.
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  file_->path = path;
  file_->side_px = side_px;
  file_->size = plan.size;
  const cv::Size tiles = tiles_of(plan.size, side_px);
  file_->is_written.resize(static_cast<std::size_t>(tiles.width) *
                           static_cast<std::size_t>(tiles.height));
  file_->tiff.reset(XTIFFOpen(path.c_str(), needs_big_tiff(plan) ? "w8" : "w"));
  if (!file_->tiff) file_->fail();
  set_format(file_->tiff.get(), plan.size, side_px);
  if (!set_place(file_->tiff.get(), earth, plan)) file_->fail();
}

GeoTiff::~GeoTiff() = default;

void GeoTiff::write(const MosaicTile& tile) {
  const int side_px = file_->side_px;
  // Tiles of a TIFF are never cut: what lies beyond the border is not shown.
  cv::Mat whole(side_px, side_px, CV_8U, cv::Scalar(kUnseen));
  tile.picture.copyTo(whole({0, 0, tile.picture.cols, tile.picture.rows}));
  const int columns = tiles_of(file_->size, side_px).width;
  const std::size_t number =
      static_cast<std::size_t>(tile.row) * static_cast<std::size_t>(columns) +
      static_cast<std::size_t>(tile.column);
  file_->put(number, whole);
  file_->is_written[number] = true;
}

void GeoTiff::finish() {
  for (std::size_t i = 0; i < file_->is_written.size(); ++i) {
    // A fresh one each: the predictor works in place.
    if (file_->is_written[i]) continue;
    file_->put(i, cv::Mat(file_->side_px, file_->side_px, CV_8U, cv::Scalar(kUnseen)));
  }
  file_->end_directory();
  file_->write_overviews();
  file_->tiff.reset();
}
#else
struct GeoTiff::File {};

// An EarthFrame cannot be had either: none of this is called.
GeoTiff::GeoTiff(const std::filesystem::path& path, const EarthFrame& /*earth*/,
                 const MosaicPlan& /*plan*/, int /*side_px*/) {
  throw InputError(path.string(), refusal_without("geotiff"));
}
GeoTiff::~GeoTiff() = default;
void GeoTiff::write(const MosaicTile& /*tile*/) {}
void GeoTiff::finish() {}
#endif

}  // namespace fathom
