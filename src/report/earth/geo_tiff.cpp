#include "fathom/report/geo_tiff.hpp"

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

// Within 4 GB of offsets also where nothing can be compressed.
bool needs_big_tiff(const MosaicPlan& plan) {
  return static_cast<double>(plan.size.width) * plan.size.height > 3.9e9;
}

void declare_no_data(TIFF* file) {
  static char name[] = "GDALNoDataValue";
  static const TIFFFieldInfo field[] = {
      {kNoDataTag, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_ASCII, FIELD_CUSTOM, 1, 0, name}};
  TIFFMergeFieldInfo(file, field, 1);
  TIFFSetField(file, kNoDataTag, std::to_string(kUnseen).c_str());
}

void set_format(TIFF* file, const MosaicPlan& plan, int side_px) {
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(plan.size.width));
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(plan.size.height));
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
  int side_px = 0;
  int columns = 0;
  std::vector<bool> is_written;  ///< by tile, row by row

  [[noreturn]] void fail() const {
    throw InputError(path.string(), "cannot be written; is the disk full?");
  }

  void put(std::size_t tile, const cv::Mat& pixels) {
    const auto number = static_cast<std::uint32_t>(tile);
    if (TIFFWriteEncodedTile(tiff.get(), number, pixels.data,
                             static_cast<tmsize_t>(pixels.total())) < 0) {
      fail();
    }
    is_written[tile] = true;
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
  file_->columns = (plan.size.width + side_px - 1) / side_px;
  const int rows = (plan.size.height + side_px - 1) / side_px;
  file_->is_written.resize(static_cast<std::size_t>(file_->columns) *
                           static_cast<std::size_t>(rows));
  file_->tiff.reset(XTIFFOpen(path.c_str(), needs_big_tiff(plan) ? "w8" : "w"));
  if (!file_->tiff) file_->fail();
  set_format(file_->tiff.get(), plan, side_px);
  if (!set_place(file_->tiff.get(), earth, plan)) file_->fail();
}

GeoTiff::~GeoTiff() = default;

void GeoTiff::write(const MosaicTile& tile) {
  const int side_px = file_->side_px;
  // Tiles of a TIFF are never cut: what lies beyond the border is not shown.
  cv::Mat whole(side_px, side_px, CV_8U, cv::Scalar(kUnseen));
  tile.picture.copyTo(whole({0, 0, tile.picture.cols, tile.picture.rows}));
  file_->put(static_cast<std::size_t>(tile.row) * static_cast<std::size_t>(file_->columns) +
                 static_cast<std::size_t>(tile.column),
             whole);
}

void GeoTiff::finish() {
  for (std::size_t i = 0; i < file_->is_written.size(); ++i) {
    // A fresh one each: the predictor works in place.
    if (file_->is_written[i]) continue;
    file_->put(i, cv::Mat(file_->side_px, file_->side_px, CV_8U, cv::Scalar(kUnseen)));
  }
  if (TIFFFlush(file_->tiff.get()) == 0) file_->fail();
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
