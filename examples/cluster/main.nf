// nextflow run main.nf -resume --shards 40 --records curves --test test.toml
process SHARD {
    cpus 1
    time '1h'
    errorStrategy 'retry'
    maxRetries 2

    input:
    val number
    path records
    path test

    output:
    path 'shard'

    script:
    "palpate batch $records --test $test --out shard --shard $number/${params.shards} --threads ${task.cpus}"
}

process MERGE {
    publishDir '.', mode: 'copy'

    input:
    path 'shard*'

    output:
    path 'table*.parquet'

    script:
    // Exit code 1: merged, and some tests failed.
    "palpate merge shard* --out table.parquet || [ \$? -eq 1 ]"
}

workflow {
    MERGE(SHARD(channel.of(1..(params.shards as int)), file(params.records), file(params.test)).collect())
}
