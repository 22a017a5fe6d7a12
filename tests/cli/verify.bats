# verify.bats - reference vectors that are wrong, incomplete or misspelt, and what becomes of the exit status.
load helper

fourbar=tests/data/vectors/closed_fourbar.json

# changed SED-SCRIPT: the four-bar's vector, changed.
changed() { sed "$1" "$MIMDSIM_SRCDIR/$fourbar" >x.json; }

@test "a key that the format does not have is named with its line and the nearest one" {
    while IFS='|' read -r script message; do
        changed "$script"
        fails_with 65 mimdsim verify --serial x.json
        stderr_says "$message"
        [[ $stderr =~ x\.json:[1-9] ]]
    done <<'END'
s/"qdd_fd": \[-45/"qdd_df": [-45/|unknown key 'qdd_df'; did you mean 'qdd_fd'?
s/"kinetic": 0.0/"kinetik": 0.0/|unknown key 'kinetik'; did you mean 'kinetic'?
s/"alpha"/"alhpa"/|unknown key 'alhpa'; did you mean 'alpha'?
s/"com": /"cmo": /|unknown key 'cmo'; did you mean 'com'?
s/"f_ext"/"f_ex"/;s/"gravity": /"zzzzzzzzzz": 1, "gravity": /|unknown key 'zzzzzzzzzz'
END
}

@test "a missing answer is an error, unless the file says what it has" {
    changed 's/"bias": /"comment": /'
    fails_with 65 mimdsim verify --serial x.json
    stderr_says "the answer 'bias' is missing"
    printf '%s' '"answers": ["tau_id", "qdd_fd", "lambda", "gravity_torque", "M", "energy", "momentum",' >list
    printf '%s\n' ' "com_world", "fk", "joint_wrench_id"], ' >>list
    sed -i "s/\"format\": /$(cat list)\"format\": /" x.json
    works mimdsim verify --serial x.json
    sed -i 's/"answers": \["tau_id", /"answers": ["tau_id", "bias", /' x.json
    fails_with 65 mimdsim verify --serial x.json
    sed -i 's/"answers": \["tau_id", "bias", /"answers": ["tau_di", /' x.json
    fails_with 65 mimdsim verify --serial x.json
    stderr_says "did you mean 'tau_id'?"
}

@test "a rotation that is not its quaternion's and a robot that is not there are errors" {
    changed '0,/"R": \[1.0, 0.0/s//"R": [0.999999, 0.0/'
    fails_with 65 mimdsim verify --serial x.json
    stderr_says "number 1 of 'R' is 0.999999"
    changed 's/"format": /"urdf": "robot.urdf", "format": /'
    fails_with 65 mimdsim verify --serial x.json
    stderr_says "the URDF file 'robot.urdf' does not exist"
}

@test "a wrong answer ends with status 1, whatever the file says of roundings" {
    changed 's/"qdd_fd": \[-45.57/"qdd_fd": [-45.58/;s/"input_rounding_floor": {"tau_id": [^,]*, "qdd_fd": [^}]*}/"input_rounding_floor": {"tau_id": 1, "qdd_fd": 1}/'
    fails_with 1 mimdsim verify x.json
    stdout_says "FAIL"
    fails_with 1 mimdsim verify --precision quad x.json
    changed 's/"qdd_fd": \[-45.57/"qdd_fd": [-145.57/'
    fails_with 1 mimdsim verify --precision float x.json
}

@test "algorithms that fail in quad precision too are listed with what to use, and count when asked" {
    works mimdsim verify "$MIMDSIM_SRCDIR/tests/data/vectors/x_tinylinks_n0012.json"
    stdout_says "algorithm-fails: breaks down; in quad precision 1.6e-07; use cfa-robust"
    stdout_says "25 algorithm-fails, 0 fail"
    fails_with 1 mimdsim verify --strict "$MIMDSIM_SRCDIR/tests/data/vectors/x_tinylinks_n0012.json"
    works mimdsim verify --strict "$MIMDSIM_SRCDIR/$fourbar"
}
