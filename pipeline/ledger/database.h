#pragma once

#include "io/error.h"

#include <cstdint>
#include <filesystem>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace hsgm::ledger {

/// A ledger that is no database, is cut short, or does not hold together.
class DamagedError : public io::StorageError {
    using StorageError::StorageError;
};

/// Another process keeps the ledger locked for longer than anybody should.
class BusyError : public io::StorageError {
    using StorageError::StorageError;
};

/// One SQLite file. Not thread-safe; the file may be read by others meanwhile. Uses a rollback
/// journal, because a write-ahead log does not work across hosts, and waits for the disk.
class Database {
public:
    enum class Access {
        make,     ///< for writing; a new one where there is none
        fleeting, ///< the same, but without waiting for the disk: a power cut may spoil it
        read      ///< only looks; still rolls back what a killed writer left half done
    };

    /// Throws StorageError where the file cannot be opened, DamagedError where it is none, and
    /// BusyError, as all the rest, where another process keeps it locked.
    Database(const std::filesystem::path& path, Access access);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    /// One or more statements without results.
    void execute(const char* sql);
    /// Throws DamagedError where the file does not hold together.
    void check_whole();
    const std::filesystem::path& path() const { return path_; }

private:
    friend class Statement;
    [[noreturn]] void fail(int code) const;

    std::filesystem::path path_;
    sqlite3* handle_ = nullptr;
};

/// One statement, with ? for what `bind` puts in, in turn. Rows come by `step`.
class Statement {
public:
    Statement(Database& database, const char* sql);
    ~Statement();
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    Statement& bind(std::int64_t value);
    Statement& bind(double value);
    Statement& bind(const std::string& value);

    /// True: there is a row. False: no more; the statement may be bound anew.
    bool step();
    /// For statements without rows.
    void run() { step(); }

    std::int64_t integer(int column) const;
    double number(int column) const;
    std::string text(int column) const;

private:
    void check(int code) const;

    Database& database_;
    sqlite3_stmt* handle_ = nullptr;
    int bound_ = 0;
};

/// All or nothing: what is not committed is taken back.
class Transaction {
public:
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    void commit();

private:
    Database& database_;
    bool open_ = true;
};

} // namespace hsgm::ledger
