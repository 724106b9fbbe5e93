#pragma once

// Private to this folder.

#include "io/rpc_metadata.h"

#include <map>
#include <span>
#include <string>

namespace hsgm::io {

/// The values of a model by the keys of GDAL's RPC domain: LINE_OFF ..., and
/// LINE_NUM_COEFF ... with 20 numbers each, in the order of RPC00B.
using RpcItems = std::map<std::string, std::string>;

/// Throws InputError naming `origin` and the key that is missing or no number.
RpcMetadata rpc_from_items(const RpcItems& items, const std::string& origin);

} // namespace hsgm::io
