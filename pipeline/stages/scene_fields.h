#pragma once

#include "pipeline/synth/scene.h"

#include <array>
#include <string_view>
#include <utility>

namespace hsgm::pipeline {

/// The keys of a scene's YAML, once for reading and writing. A visitor has
///   value(key, number)                 int, unsigned 64-bit or double
///   size(key, tiling::Size)            [rows, columns]
///   choice(key, enumerator, names)     names: pairs of enumerator and word
///   section(key, struct)               visits the struct's own fields
///   optional_section(key, optional)    likewise; absent where the key is
///   list(key, vector of structs)

inline constexpr std::array<std::pair<synth::Shape, std::string_view>, 2> kShapeNames{
    {{synth::Shape::rectangle, "rectangle"}, {synth::Shape::ellipse, "ellipse"}}};

inline constexpr std::array<std::pair<synth::Roof, std::string_view>, 3> kRoofNames{
    {{synth::Roof::flat, "flat"},
     {synth::Roof::slope, "slope"},
     {synth::Roof::gable, "gable"}}};

template <typename Visitor>
void visit_fields(Visitor& v, synth::Texture& t)
{
    v.value("mean", t.mean);
    v.value("contrast", t.contrast);
    v.value("finest_px", t.finest_px);
    v.value("octaves", t.octaves);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::Wave& w)
{
    v.value("amplitude_px", w.amplitude_px);
    v.value("wavelength_px", w.wavelength_px);
    v.value("direction_deg", w.direction_deg);
    v.value("phase_deg", w.phase_deg);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::Terrain& t)
{
    v.value("offset_px", t.offset_px);
    v.value("slope_x", t.slope_x);
    v.value("slope_y", t.slope_y);
    v.list("waves", t.waves);
    v.section("texture", t.texture);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::Object& o)
{
    v.choice("shape", o.shape, kShapeNames);
    v.value("center_x", o.center_x);
    v.value("center_y", o.center_y);
    v.value("length_px", o.length_px);
    v.value("width_px", o.width_px);
    v.value("angle_deg", o.angle_deg);
    v.value("height_px", o.height_px);
    v.choice("roof", o.roof, kRoofNames);
    v.value("rise_px", o.rise_px);
    v.section("texture", o.texture);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::City& c)
{
    v.value("cell_px", c.cell_px);
    v.value("street_px", c.street_px);
    v.value("fill", c.fill);
    v.value("slanted", c.slanted);
    v.value("rotated", c.rotated);
    v.value("plain", c.plain);
    v.value("plain_contrast", c.plain_contrast);
    v.value("height_min_px", c.height_min_px);
    v.value("height_max_px", c.height_max_px);
    v.section("texture", c.texture);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::LowTexture& a)
{
    v.value("x", a.x);
    v.value("y", a.y);
    v.value("cols", a.cols);
    v.value("rows", a.rows);
    v.value("contrast_scale", a.contrast_scale);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::Hole& h)
{
    v.value("center_x", h.center_x);
    v.value("center_y", h.center_y);
    v.value("radius_px", h.radius_px);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::Sensor& s)
{
    v.value("gain", s.gain);
    v.value("offset", s.offset);
    v.value("gamma", s.gamma);
    v.value("noise_gray", s.noise_gray);
    v.value("nodata_border_px", s.nodata_border_px);
    v.list("holes", s.holes);
}

template <typename Visitor>
void visit_fields(Visitor& v, synth::Scene& s)
{
    v.size("size", s.size);
    v.value("seed", s.seed);
    v.value("bits", s.bits);
    v.section("terrain", s.terrain);
    v.list("objects", s.objects);
    v.optional_section("city", s.city);
    v.list("low_texture", s.low_texture);
    v.section("left", s.left);
    v.section("right", s.right);
}

} // namespace hsgm::pipeline
