#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The queries of share/examples/shares: sqlite3, and DuckDB where it is, find in the lines of the parts what is in the
# table of `join`, also if a job has failed.
. "$(dirname "$0")/../pipelines/common.sh"

/usr/bin/python3 -c 'import yaml' 2>/dev/null || skip "no python3-yaml"
command -v sqlite3 >/dev/null || command -v duckdb >/dev/null || skip "neither sqlite3 nor duckdb"
cp "$source_dir"/share/examples/shares/{sweep.yaml,best.sql,best.sqlite} "$scenes/l-room.env" .
sed -i 's/1\.\.400/1..40/' sweep.yaml
# Seed 7 fails: a part has lines with a message, and without a report.
mkdir bin
cat >bin/coverage <<END
#!/bin/sh
case \$2 in *seed7.3dm) echo "too much" >&2; exit 1;; esac
exec $binary_dir/bin/coverage "\$@"
END
chmod +x bin/coverage
PATH=$scratch/bin:$PATH
for i in 1 2 3 4; do
    expect=0
    [ "$i" -ne 1 ] || expect=1
    expect_status $expect ispace-sweep run sweep.yaml --shard "$i/4" -q -o "part$i.jsonl"
done
ispace-sweep join part*.jsonl --partial -q -o table.csv
/usr/bin/python3 - table.csv >expected <<'END'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1], encoding="utf-8")))
assert len(rows) == 39, len(rows)
rows.sort(key=lambda row: (-float(row["coverage.exact"]), int(row["seed"])))
print("seed,coverage", *(f"{row['seed']},{row['coverage.exact']}" for row in rows[:5]), sep="\n")
END
ran=""
if command -v sqlite3 >/dev/null; then
    sqlite3 <best.sqlite | tr -d '\r' >found
    expect_same expected found "sqlite3 finds other seeds"
    ran="$ran sqlite3"
fi
if command -v duckdb >/dev/null; then
    duckdb -csv <best.sql | head -n 6 | tr -d '\r' >found
    expect_same expected found "DuckDB finds other seeds"
    duckdb -csv -noheader -c "SELECT count(*), count(coverage) FROM 'table.parquet'" | has '40,39' ||
        fail "another table.parquet"
    ran="$ran duckdb"
fi
echo "ran:$ran"
