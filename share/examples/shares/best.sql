-- SPDX-License-Identifier: GPL-3.0-or-later
-- duckdb -csv <best.sql: the five seeds with the largest covered share of the room, from the parts of the sweep. Then all
-- jobs as a table for other programs, in Parquet. The first line of a part describes it, and has no job.
SELECT "values".seed AS seed, reports.".json".coverage.exact AS coverage
FROM read_json('part*.jsonl', format = 'newline_delimited', union_by_name = true, maximum_object_size = 268435456)
WHERE status = 0 ORDER BY coverage DESC, seed LIMIT 5;

COPY (SELECT job, status, unnest("values"), reports.".json".coverage.exact AS coverage
      FROM read_json('part*.jsonl', format = 'newline_delimited', union_by_name = true, maximum_object_size = 268435456)
      WHERE job IS NOT NULL ORDER BY job)
TO 'table.parquet' (FORMAT parquet);
