#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A file of 60 MB with thousands of houses side by side: 20 s of processor time and 2 GB are enough;
# a damaged one is an error, and a loop in a placement costs no more.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

python3 - "$source_dir/lib/extensions/ifc/golden/inputs/ifc/cabin-2x3-mm.ifc" <<'PY'
import re, sys
text = open(sys.argv[1]).read()
head, rest = text.split('DATA;\n')
house = rest.split('ENDSEC;')[0]
count = max(map(int, re.findall(r'#(\d+)', house)))
# The origin of the site is the first point that its placement names.
site = re.search(r"IFCSITE\('\d+',\$,'Site',\$,\$,#(\d+)", house).group(1)
axes = re.search(rf'#{site}=IFCLOCALPLACEMENT\(\$,#(\d+)\)', house).group(1)
origin = re.search(rf'#{axes}=IFCAXIS2PLACEMENT3D\(#(\d+)', house).group(1)
copies = 60_000_000 // len(house)
with open('town.ifc', 'w') as town:
    town.write(head + 'DATA;\n')
    for i in range(copies):
        moved = re.sub(rf'#{origin}=.*', f'#{origin}=IFCCARTESIANPOINT(({i % 70 * 9000}.,{i // 70 * 9000}.,0.));',
                       house, count=1)
        town.write(re.sub(r'#(\d+)', lambda n: f'#{int(n[1]) + i * (count + 1)}', moved)
                   .replace("'House'", f"'House {i}'"))
    town.write('ENDSEC;\nEND-ISO-10303-21;\n')
PY
[ "$(stat -c %s town.ifc)" -gt 60000000 ] || fail "the town is too small"

# Of the tool and the reader that it starts.
/usr/bin/env python3 - <<'PY' || fail "too slow, or too much memory"
import resource, subprocess, sys
done = subprocess.run(['envc', 'town.ifc', '--storey', 'House 17/Ground floor', '--info'],
                      capture_output=True, text=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
sys.stdout.write(done.stdout + done.stderr[:300] + '\n')
seconds, megabytes = used.ru_utime + used.ru_stime, used.ru_maxrss / 1024
print(f'{seconds:.1f} s, {megabytes:.0f} MB')
sys.exit(done.returncode or seconds > 20 or megabytes > 2000 or
         '24.0 m2' not in done.stdout.replace('23.950', '24.0') or 'zone 2' not in done.stdout)
PY

head -c 30000000 town.ifc >half.ifc
expect_error 1 envc half.ifc --info
