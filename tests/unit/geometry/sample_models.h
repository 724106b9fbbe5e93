#pragma once

#include "pipeline/geometry/rpc_camera.h"

namespace hsgm::geometry::samples {

/// A plausible satellite image of about half a metre per pixel, 20 000 px a side, over
/// 45 degrees north, 7 degrees east: lines run south, samples east, and a point moves by
/// `lean_line` lines and `lean_samp` samples for a metre of height. Small terms of second and
/// third order and denominators make it no plane affinity.
inline RpcModel model(double lean_line = 0.3, double lean_samp = 0.1)
{
    RpcModel m;
    m.line_off = 9999.5;
    m.samp_off = 9999.5;
    m.lat_off_deg = 45;
    m.long_off_deg = 7;
    m.height_off_m = 500;
    m.line_scale = 10000;
    m.samp_scale = 10000;
    m.lat_scale_deg = 0.045;
    m.long_scale_deg = 0.0635;
    m.height_scale_m = 500;
    // Terms: 1 l p h  lp lh ph  ll pp hh  plh  lll lpp lhh  llp ppp phh  llh pph hhh
    m.samp_num = {1e-4,  1.0,   -0.02, lean_samp * 500 / 10000,
                  2e-4,  -1e-5, 3e-6,  -2e-5,
                  1e-5,  -2e-7, 1e-7,  3e-7,
                  -2e-7, 1e-8,  2e-7,  1e-7,
                  3e-9,  -2e-8, 1e-8,  1e-9};
    m.samp_den = {1, 2e-4, -3e-4, -5e-5, 1e-6, 2e-7, -1e-7, 3e-6, 1e-6, 1e-8};
    m.line_num = {-2e-4, -0.03, -1.0,  lean_line * 500 / 10000,
                  1e-4,  2e-6,  -1e-5, 3e-5,
                  2e-5,  1e-7,  -1e-7, 2e-7,
                  1e-7,  2e-9,  -3e-7, 2e-7,
                  1e-9,  1e-8,  -2e-8, 2e-9};
    m.line_den = {1, -1e-4, 2e-4, -4e-5, 2e-6, 1e-7, 2e-7, -1e-6, 2e-6, -1e-8};
    return m;
}

} // namespace hsgm::geometry::samples
