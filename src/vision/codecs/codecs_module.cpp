// The module of the program that is loaded with the first picture.
#include "opencv_codecs.hpp"
#include "picture_codecs.hpp"

extern "C" {
extern const fathom::PictureCodecs fathom_picture_codecs;
const fathom::PictureCodecs fathom_picture_codecs{fathom::opencv_codecs::decode,
                                                  fathom::opencv_codecs::encode};
}
