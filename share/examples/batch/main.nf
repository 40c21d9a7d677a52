// SPDX-License-Identifier: GPL-3.0-or-later
// nextflow run main.nf: the sweep's jobs, its table and its picture. Jobs work in the folder where Nextflow
// was started, which the nodes share; --missing takes the place of -resume.
nextflow.enable.dsl = 2

process job {
    tag "$name"
    cpus 1
    errorStrategy 'retry'
    maxRetries 2

    input:
    tuple val(name), val(command)

    output:
    val name

    script:
    """
    cd '${launchDir}'
    ${command}
    """
}

process table {
    input:
    val names

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
    listing = ['ispace-sweep', 'commands', 'sweep.yaml', '-j', '1', '--missing', '--json'].execute(null, launchDir.toFile())
    lines = listing.inputStream.text.readLines()
    if (listing.waitFor() != 0) error listing.errorStream.text
    jobs = lines.drop(1).collect { new groovy.json.JsonSlurper().parseText(it) }
    job(Channel.fromList(jobs.collect { tuple(it.name, it.command) }))
    table(job.out.collect().ifEmpty([]))
}
