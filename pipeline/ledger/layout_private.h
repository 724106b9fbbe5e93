#pragma once

#include "pipeline/ledger/database.h"
#include "pipeline/ledger/rows.h"

#include <vector>

// The tables of a ledger, and how their rows are read.
namespace hsgm::ledger {

/// In the file's header: "hsgm", and the version of the tables below.
constexpr std::int64_t kApplicationId = 0x6873676D;
constexpr std::int64_t kLayoutVersion = 1;

constexpr const char* kTables = R"(
CREATE TABLE facts(name TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE owners(token INTEGER PRIMARY KEY, part INTEGER NOT NULL, host TEXT NOT NULL,
  pid INTEGER NOT NULL, job TEXT NOT NULL, restarts INTEGER NOT NULL, program TEXT NOT NULL,
  started_s REAL NOT NULL);
CREATE TABLE tiles(id INTEGER PRIMARY KEY, stage TEXT NOT NULL, row INTEGER NOT NULL,
  col INTEGER NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT NULL,
  state TEXT NOT NULL CHECK(state IN ('pending', 'running', 'done', 'failed')),
  attempts INTEGER NOT NULL DEFAULT 0, deaths INTEGER NOT NULL DEFAULT 0,
  part INTEGER NOT NULL DEFAULT 0, worker TEXT NOT NULL DEFAULT '',
  started_s REAL NOT NULL DEFAULT 0, seconds REAL NOT NULL DEFAULT 0,
  checksum TEXT NOT NULL DEFAULT '', reason TEXT NOT NULL DEFAULT '',
  UNIQUE(stage, row, col, rows, cols));
CREATE TABLE attempts(id INTEGER PRIMARY KEY, stage TEXT NOT NULL, row INTEGER NOT NULL,
  col INTEGER NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT NULL, token INTEGER NOT NULL,
  worker TEXT NOT NULL, started_s REAL NOT NULL, seconds REAL NOT NULL, outcome TEXT NOT NULL,
  reason TEXT NOT NULL);
)";

/// Throws DamagedError or VersionError where the file is no ledger of this layout.
void check_layout(Database& database);

std::vector<Owner> read_owners(Database& database);
/// Of one stage, or of all for an empty name.
std::vector<TileRow> read_tiles(Database& database, const std::string& stage);

} // namespace hsgm::ledger
