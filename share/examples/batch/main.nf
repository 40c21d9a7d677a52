// SPDX-License-Identifier: GPL-3.0-or-later
// nextflow run main.nf: the sweep's jobs, its table and its picture. Jobs work in the folder where Nextflow
// was started, which the nodes share; --missing replaces -resume. Written for DSL 2 in the
// strict syntax of Nextflow 26.04; it has never been run.

process list_jobs {
    output:
    stdout

    script:
    """
    cd '${launchDir}'
    ispace-sweep commands sweep.yaml --missing -j 1
    """
}

process run_job {
    cpus 1
    errorStrategy 'retry'
    maxRetries 2

    input:
    val command

    output:
    val true

    script:
    """
    cd '${launchDir}'
    ${command}
    """
}

process join_results {
    input:
    val done

    output:
    stdout

    script:
    """
    cd '${launchDir}'
    ispace-sweep join sweep.yaml -o table.csv
    ispace-sweep plot sweep.yaml --x count --by device -o curves.svg
    """
}

workflow {
    list_jobs()
    run_job(list_jobs.out.splitText())
    join_results(run_job.out.collect().ifEmpty([]))
}
