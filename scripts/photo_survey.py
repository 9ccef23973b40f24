#!/usr/bin/env python3
"""Makes an image folder of photos that have their positions in their EXIF: docs/real_surveys.md.

The positions go to a reference beside the folder. No estimator sees them, but for those that
--fixes gives it. The map's x is north, its y west, its origin the first photo.
"""

import argparse
import datetime
import math
import re
import shutil
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 7: 1, 9: 4, 10: 8}  # bytes of a value of each EXIF type
FORMATS = {1: "B", 3: "H", 4: "I", 9: "i"}
EXIF_FOLDER, GPS_FOLDER, TIME = 0x8769, 0x8825, 0x9003
# DJI writes height over the place of take-off and the camera's heading into the XMP.
DJI = re.compile(rb'drone-dji:(RelativeAltitude|GimbalYawDegree)="([^"]*)"')


class BadPhoto(Exception):
    """What is wrong with a photo, or with what was asked for."""


@dataclass
class Photo:
    """What a camera wrote into a photo."""

    path: Path
    time_ns: int
    latitude: float  # degrees
    longitude: float
    altitude_m: float  # by GPS; nothing where it is not said
    height_m: float  # over take-off, likewise
    yaw: float  # radians, clockwise from north, likewise


def _folder(data, order, offset):
    """The values of an EXIF folder by their tags: text, or lists of numbers."""
    found = {}
    for k in range(struct.unpack_from(order + "H", data, offset)[0]):
        entry = offset + 2 + 12 * k
        tag, kind, count = struct.unpack_from(order + "HHI", data, entry)
        place = entry + 8
        if SIZES.get(kind, 1) * count > 4:
            place = struct.unpack_from(order + "I", data, place)[0]
        if kind == 2:
            found[tag] = data[place:place + count].split(b"\0")[0].decode("latin-1")
        elif kind in FORMATS:
            found[tag] = struct.unpack_from(f"{order}{count}{FORMATS[kind]}", data, place)
        elif kind in (5, 10):
            numbers = f"{order}{2 * count}{'I' if kind == 5 else 'i'}"
            pairs = struct.unpack_from(numbers, data, place)
            found[tag] = [a / b if b else math.nan for a, b in zip(pairs[::2], pairs[1::2])]
    return found


def _degrees(folder, value, sign, negative):
    degrees, minutes, seconds = folder[value]
    angle = degrees + minutes / 60 + seconds / 3600
    return -angle if folder[sign].startswith(negative) else angle


def _time_ns(text):
    time = datetime.datetime.strptime(text, "%Y:%m:%d %H:%M:%S")
    return int(time.replace(tzinfo=datetime.timezone.utc).timestamp()) * 10**9


def read_photo(path):
    """Time and position of a photo."""
    content = path.read_bytes()
    start = content.find(b"Exif\0\0")
    if start < 0:
        raise BadPhoto(f"{path}: has no EXIF")
    data = content[start + 6:start + 6 + 2**16]
    order = "<" if data[:2] == b"II" else ">"
    try:
        first = _folder(data, order, struct.unpack_from(order + "I", data, 4)[0])
        exif = _folder(data, order, first[EXIF_FOLDER][0])
        gps = _folder(data, order, first[GPS_FOLDER][0])
        latitude, longitude = _degrees(gps, 2, 1, "S"), _degrees(gps, 4, 3, "W")
        time_ns = _time_ns(exif[TIME])
    except (KeyError, ValueError, struct.error) as error:
        raise BadPhoto(f"{path}: its EXIF has no time or no position") from error
    altitude_m = gps.get(6, [None])[0]
    if altitude_m is not None and gps.get(5, [0])[0] == 1:  # below sea level
        altitude_m = -altitude_m
    dji = {name.decode(): float(value) for name, value in DJI.findall(content)}
    yaw = dji.get("GimbalYawDegree")
    return Photo(path, time_ns, latitude, longitude, altitude_m,
                 dji.get("RelativeAltitude"), None if yaw is None else math.radians(yaw))


def north_west(photo, origin):
    """Metres north and west of the origin: on the tangent plane of WGS 84, for a few km."""
    a, e2 = 6378137.0, 0.00669437999
    sine = math.sin(math.radians(origin.latitude))
    meridian = a * (1 - e2) / (1 - e2 * sine * sine) ** 1.5
    parallel = a / math.sqrt(1 - e2 * sine * sine) * math.cos(math.radians(origin.latitude))
    return (math.radians(photo.latitude - origin.latitude) * meridian,
            -math.radians(photo.longitude - origin.longitude) * parallel)


def height_of(photo, options):
    """The camera's height over the floor."""
    if options.altitude_m is not None:
        return options.altitude_m
    if options.ground_m is not None:
        if photo.altitude_m is None:
            raise BadPhoto(f"{photo.path}: has no altitude by GPS; give --altitude-m")
        return photo.altitude_m - options.ground_m
    if photo.height_m is None:
        raise BadPhoto(f"{photo.path}: says no height over take-off; "
                       "give --altitude-m or --ground-m")
    return photo.height_m


def chosen(options):
    """The photos, in the order of their names."""
    paths = [path for path in sorted(options.photos.iterdir())
             if path.suffix.lower() in (".jpg", ".jpeg")
             and (not options.first or path.name >= options.first)
             and (not options.last or path.name <= options.last)]
    if not paths:
        raise BadPhoto(f"{options.photos}: no photos (.jpg)")
    photos = [read_photo(path) for path in paths]
    for earlier, later in zip(photos, photos[1:]):
        if later.time_ns <= earlier.time_ns:
            raise BadPhoto(f"{later.path}: not later than the photo before it, by its EXIF")
    return photos


def write_picture(source, target, reduce):
    """Copies a photo, or each of its sides divided by `reduce`."""
    if reduce == 1:
        shutil.copyfile(source, target)
        return
    share = f"{100 / reduce}%"
    subprocess.run(["gdal_translate", "-q", "--config", "GDAL_PAM_ENABLED", "NO", "--config",
                    "CPL_LOG", "/dev/null", "-of", "JPEG", "-co", "QUALITY=95", "-r", "average",
                    "-outsize", share, share, str(source), str(target)], check=True)


def size_of(picture):
    """Width and height of a JPEG: of its frame header."""
    content, place = picture.read_bytes(), 2
    while content[place] == 0xFF:
        marker, length = content[place + 1], struct.unpack_from(">H", content, place + 2)[0]
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height, width = struct.unpack_from(">HH", content, place + 5)
            return width, height
        place += 2 + length
    raise BadPhoto(f"{picture}: no JPEG")


def write_rows(path, head, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")


def tum_row(photo, origin):
    north, west = north_west(photo, origin)
    half = -(photo.yaw or 0.0) / 2
    return (f"{photo.time_ns / 1e9:.9f} {north:.3f} {west:.3f} 0 0 0 {math.sin(half):.9f} "
            f"{math.cos(half):.9f}")


def write_survey(photos, options):
    """mav0/, reference.tum and, with fixes, held_out.tum."""
    top, origin = options.out / "mav0", photos[0]
    (top / "cam0/data").mkdir(parents=True)
    for photo in photos:
        write_picture(photo.path, top / "cam0/data" / photo.path.name, options.reduce)
    write_rows(top / "cam0/data.csv", ["#timestamp [ns],filename"],
               [f"{photo.time_ns},{photo.path.name}" for photo in photos])
    width, height = size_of(top / "cam0/data" / origin.path.name)
    focal = options.focal_px / options.reduce
    write_rows(top / "cam0/sensor.yaml", [],
               [f"resolution: [{width}, {height}]",
                f"intrinsics: [{focal}, {focal}, {(width - 1) / 2}, {(height - 1) / 2}]"])
    write_rows(top / "altimeter0/data.csv", ["#timestamp [ns],altitude [m]"],
               [f"{photo.time_ns},{height_of(photo, options):.3f}" for photo in photos])
    write_rows(options.out / "reference.tum", [], [tum_row(photo, origin) for photo in photos])
    if options.fixes == "none":
        return
    given = photos if options.fixes == "all" else photos[::2]
    variance = options.sigma_m**2
    write_rows(top / "position0/data.csv",
               ["#timestamp [ns],x [m],y [m],var_x [m^2],cov_xy [m^2],var_y [m^2]"],
               [f"{photo.time_ns},{x:.3f},{y:.3f},{variance},0,{variance}"
                for photo in given for x, y in [north_west(photo, origin)]])
    if options.fixes == "even":
        write_rows(options.out / "held_out.tum", [], [tum_row(p, origin) for p in photos[1::2]])


def write_whole(photos, options):
    """Writes all beside the folder, and moves it there at the end: a folder is whole."""
    target = options.out
    options.out = target.with_name(target.name + ".new")
    shutil.rmtree(options.out, ignore_errors=True)
    try:
        write_survey(photos, options)
        options.out.rename(target)
    finally:
        shutil.rmtree(options.out, ignore_errors=True)


def parsed(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("photos", type=Path, help="folder of .jpg files that look straight down")
    add("--out", type=Path, required=True, help="folder to write, must not be there")
    add("--focal-px", type=float, required=True, help="focal length of the photos, in pixels")
    add("--altitude-m", type=float, help="one height over the floor; default: what DJI wrote")
    add("--ground-m", type=float, help="altitude of the floor by GPS, taken off that of the photos")
    add("--reduce", type=int, default=1, help="divide width and height; needs gdal_translate")
    add("--first", help="name of the first photo")
    add("--last", help="name of the last photo")
    add("--fixes", choices=("none", "all", "even"), default="none",
        help="photos whose position the estimators get; even: every other one, from the first")
    add("--sigma-m", type=float, default=3.0, help="standard deviation of a fix; default: 3")
    return parser.parse_args(arguments)


def main(arguments):
    options = parsed(arguments)
    try:
        if options.out.exists():
            raise BadPhoto(f"{options.out}: is there already")
        write_whole(chosen(options), options)
    except (BadPhoto, OSError, subprocess.CalledProcessError) as error:
        print(f"photo_survey: error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
